// SPDX-License-Identifier: MIT
#include "engine/io/file_bytes.h"
#include "engine/io/uri.h"
#include "game/bench/report/page_media.h"
#include "game/bench/report/page_template.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <set>
#include <string>

namespace shutter::bench {

namespace {

using nlohmann::json;

constexpr uint64_t kMaxFilmBytes = 64ULL << 20;

void collectFilms(const json& value, std::set<std::string>& paths) {
    if (value.is_object()) {
        for (const auto& [key, member] : value.items()) {
            if (member.is_string() && key == "film")
                paths.insert(member.get<std::string>());
            else
                collectFilms(member, paths);
        }
    } else if (value.is_array()) {
        for (const json& member : value)
            collectFilms(member, paths);
    }
}

core::Result<std::string>
readFilmAsUri(const std::filesystem::path& folder, const std::string& path) {
    // Results may come from anybody; the page is to hold nothing from outside their folder.
    const auto file = io::resolveUri(folder, path);
    if (!file)
        return file.error();
    const auto bytes = io::readFileBytes(file.value(), kMaxFilmBytes + 1);
    if (!bytes)
        return bytes.error();
    constexpr std::array<uint8_t, 4> kEbml = {0x1A, 0x45, 0xDF, 0xA3};
    const std::vector<uint8_t>& data = bytes.value();
    if (data.size() < kEbml.size() || !std::equal(kEbml.begin(), kEbml.end(), data.begin()))
        return core::makeError("'{}' is not a WebM film", file.value().string());
    if (data.size() > kMaxFilmBytes)
        return core::makeError("'{}' is larger than 64 MiB", file.value().string());
    return "data:video/webm;base64," + encodeBase64(data);
}

} // namespace

core::Result<json> embedFilms(const json& results, const std::filesystem::path& folder) {
    std::set<std::string> paths;
    collectFilms(results, paths);
    json films = json::object();
    for (const std::string& path : paths) {
        auto uri = readFilmAsUri(folder, path);
        if (!uri)
            return core::makeError("a film of the report: {}", uri.error().message);
        films[path] = std::move(uri).value();
    }
    return films;
}

} // namespace shutter::bench
