// SPDX-License-Identifier: MIT
#include "game/bench/report/report_page.h"

#include "engine/io/file_bytes.h"
#include "engine/io/uri.h"
#include "game/bench/report/page_template.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <set>

namespace shutter::bench {

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr const char* kSchema = "shutter-bench";
constexpr int kVersion = 2;
constexpr uint64_t kMaxResultsBytes = 256ULL << 20;
/// Nested objects and arrays; what walks them calls itself for each. Results have eight.
constexpr int kMaxDepth = 32;
constexpr uint64_t kMaxPictureBytes = 64ULL << 20;

/// What the page cannot do without; the rest it shows where it is there.
core::Status checkResults(const json& results) {
    if (!results.is_object() || results.value("schema", json()) != kSchema)
        return core::makeError("the results are not of the schema '{}'", kSchema);
    if (results.value("version", json()) != kVersion) {
        return core::makeError(
            "the results have version {}; this program's report is made from version {}",
            results.value("version", json()).dump(-1, ' ', true, json::error_handler_t::replace),
            kVersion
        );
    }
    for (const char* name : {"metrics", "methods", "cases"})
        if (!results.contains(name) || !results[name].is_array())
            return core::makeError("the results have no array '{}'", name);
    return {};
}

/// Every string under "image" or "errorMap", at any depth.
void collectPicturePaths(const json& value, std::set<std::string>& paths) {
    if (value.is_object()) {
        for (const auto& [key, member] : value.items()) {
            if (member.is_string() && (key == "image" || key == "errorMap"))
                paths.insert(member.get<std::string>());
            else
                collectPicturePaths(member, paths);
        }
    } else if (value.is_array()) {
        for (const json& member : value)
            collectPicturePaths(member, paths);
    }
}

core::Result<std::string> readPictureAsUri(const fs::path& folder, const std::string& path) {
    // Results may come from anybody; the page is to hold nothing from outside their folder.
    const auto file = io::resolveUri(folder, path);
    if (!file)
        return file.error();
    const auto bytes = io::readFileBytes(file.value(), kMaxPictureBytes + 1);
    if (!bytes)
        return bytes.error();
    constexpr std::array<uint8_t, 8> kPng = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
    const std::vector<uint8_t>& data = bytes.value();
    if (data.size() < kPng.size() || !std::equal(kPng.begin(), kPng.end(), data.begin()))
        return core::makeError("'{}' is not a PNG", file.value().string());
    if (data.size() > kMaxPictureBytes)
        return core::makeError("'{}' is larger than 64 MiB", file.value().string());
    return "data:image/png;base64," + encodeBase64(data);
}

/// Path to data URI.
core::Result<json> embedPictures(const json& results, const fs::path& folder) {
    std::set<std::string> paths;
    collectPicturePaths(results, paths);
    json pictures = json::object();
    for (const std::string& path : paths) {
        auto uri = readPictureAsUri(folder, path);
        if (!uri)
            return core::makeError("a picture of the report: {}", uri.error().message);
        pictures[path] = std::move(uri).value();
    }
    return pictures;
}

std::string toScript(const json& value) {
    // A name need not be UTF-8; what is not is replaced.
    return escapeForScript(value.dump(-1, ' ', false, json::error_handler_t::replace));
}

} // namespace

core::Status checkReportPageCanBeMade() {
    if (getChartJs().empty()) {
        return core::makeError(
            "this program was built without Chart.js, so it makes no report page; install the "
            "package libjs-chart.js, then configure and build again"
        );
    }
    return {};
}

core::Status writeReportPage(const json& results, const fs::path& folder) {
    SHUTTER_TRY(checkReportPageCanBeMade());
    SHUTTER_TRY(checkResults(results));
    const auto pictures = embedPictures(results, folder);
    if (!pictures)
        return pictures.error();
    const std::string resultsText = toScript(results);
    const std::string picturesText = toScript(pictures.value());
    const std::string scripts = joinReportScripts();
    const auto page = fillPage(
        getReportPage(),
        {{"style", getReportStyle()},
         {"chart", getChartJs()},
         {"results", resultsText},
         {"pictures", picturesText},
         {"scripts", scripts}}
    );
    if (!page)
        return page.error();
    return io::writeFileText(folder / "index.html", page.value());
}

core::Status remakeReportPage(const fs::path& folder) {
    const fs::path file = folder / "results.json";
    const auto bytes = io::readFileBytes(file, kMaxResultsBytes + 1);
    if (!bytes)
        return bytes.error();
    if (bytes.value().size() > kMaxResultsBytes)
        return core::makeError("'{}' is larger than 256 MiB", file.string());
    bool isTooDeep = false;
    const auto keepShallow = [&](int depth, json::parse_event_t, const json&) {
        isTooDeep = isTooDeep || depth > kMaxDepth;
        return !isTooDeep;
    };
    const json results = json::parse(bytes.value(), keepShallow, false);
    if (isTooDeep)
        return core::makeError(
            "'{}' nests objects and arrays deeper than {} levels", file.string(), kMaxDepth
        );
    if (results.is_discarded())
        return core::makeError("'{}' is not valid JSON", file.string());
    core::Status written = writeReportPage(results, folder);
    if (!written)
        return core::makeError("'{}': {}", file.string(), written.error().message);
    return {};
}

} // namespace shutter::bench
