// SPDX-License-Identifier: MIT
#include "game/bench/report/report_page.h"

#include "engine/core/log.h"
#include "engine/io/file_bytes.h"
#include "game/bench/report/page_parts.h"

#include <nlohmann/json.hpp>

#include <algorithm>

namespace shutter::bench {

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr const char* kSchema = "shutter-bench";
constexpr int kVersion = 2;
constexpr uint64_t kMaxResultsBytes = 256ULL << 20;
/// Nested objects and arrays; what walks them calls itself for each. Results have eight.
constexpr int kMaxDepth = 32;

/// Checks the fields that the page requires; others are optional.
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

std::string toScript(const json& value) {
    // A name need not be UTF-8; invalid bytes are replaced.
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
    const std::string resultsText = toScript(results);
    const std::string scripts = joinReportScripts();
    const std::string style = getReportStyle();
    const auto films = embedFilms(results, folder);
    if (!films)
        return films.error();
    const std::string filmsText = toScript(films.value());
    const auto pictures = encodePictures(results, folder);
    if (!pictures)
        return core::makeError("a picture of the report: {}", pictures.error().message);
    const std::string picturesText = toScript(pictures.value());
    const auto page = fillPage(
        getReportPage(),
        {{"style", style},
         {"chart", getChartJs()},
         {"results", resultsText},
         {"pictures", picturesText},
         {"films", filmsText},
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
