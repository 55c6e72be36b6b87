// SPDX-License-Identifier: MIT
#include "engine/core/result.h"
#include "engine/io/file_bytes.h"
#include "engine/io/image_file.h"
#include "engine/io/uri.h"
#include "game/bench/report/page_parts.h"

#include <nlohmann/json.hpp>
#include <nlohmann/json_fwd.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace shutter::bench {

namespace {

namespace fs = std::filesystem;
using core::Result;
using nlohmann::json;
using Bytes = std::vector<uint8_t>;

/// Pixels from the upper left corner of a picture.
struct PictureRegion {
    uint32_t x = 0;
    uint32_t y = 0;
    uint32_t width = 0;
    uint32_t height = 0;
};

using Crops = std::vector<PictureRegion>;

/// Files are named as the results name them, relative to their folder.
struct ShownPictures {
    std::set<std::string> whole; ///< PNG: `image` and `errorMap`, wherever they are
    /// The regions of PNG that are shown enlarged: those of a case in its `image`s. Of a row at
    /// equal time whose sample count is no default, the first is all that is shown.
    std::map<std::string, std::vector<PictureRegion>> crops;
};

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

constexpr uint64_t kMaxPictureBytes = 64ULL << 20;
/// At 640x360 a picture then takes some 50 kB, and a page of 300 of them still opens at once.
constexpr int kJpegQuality = 80;

/// Results may come from anybody; the page is to hold nothing from outside their folder.
Result<fs::path> findFile(const fs::path& folder, const std::string& path) {
    return io::resolveUri(folder, path);
}

/// Error: the file is missing, outside `folder`, no PNG or larger than 64 MiB.
Result<image::Image> readPng(const fs::path& folder, const std::string& path) {
    const auto found = findFile(folder, path);
    if (!found)
        return found.error();
    const fs::path& file = found.value();
    const auto bytes = io::readFileBytes(file, kMaxPictureBytes + 1);
    if (!bytes)
        return bytes.error();
    constexpr std::array<uint8_t, 8> kPng = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
    const Bytes& data = bytes.value();
    if (data.size() < kPng.size() || !std::equal(kPng.begin(), kPng.end(), data.begin()))
        return core::makeError("'{}' is not a PNG", file.string());
    if (data.size() > kMaxPictureBytes)
        return core::makeError("'{}' is larger than 64 MiB", file.string());
    return io::readImage(file);
}

Result<image::Image>
cutOut(const image::Image& picture, const PictureRegion& region, const fs::path& file) {
    if (uint64_t(region.x) + region.width > picture.width ||
        uint64_t(region.y) + region.height > picture.height)
        return core::makeError(
            "the crop of {}x{} at {}, {} leaves '{}', which is {}x{}",
            region.width,
            region.height,
            region.x,
            region.y,
            file.string(),
            picture.width,
            picture.height
        );
    image::Image cut(region.width, region.height, picture.channels);
    cut.channelNames = picture.channelNames;
    for (uint32_t y = 0; y < region.height; ++y) {
        const float* row =
            &picture.pixels[(size_t(region.y + y) * picture.width + region.x) * picture.channels];
        std::copy_n(
            row,
            size_t(region.width) * picture.channels,
            cut.pixels.begin() + std::ptrdiff_t(size_t(y) * region.width * picture.channels)
        );
    }
    return cut;
}

/// \param format "png" or "jpg"
Result<json> makeUri(const image::Image& picture, const std::string& format) {
    const auto bytes =
        io::encodeImage("picture." + format, picture, io::SampleType::Float, kJpegQuality);
    if (!bytes)
        return bytes.error();
    return json(fmt::format(
        "data:image/{};base64,{}", format == "jpg" ? "jpeg" : format, encodeBase64(bytes.value())
    ));
}

Result<json> cutParts(
    const image::Image& picture, const std::vector<PictureRegion>& regions, const fs::path& file
) {
    json parts = json::array();
    for (const PictureRegion& region : regions) {
        const auto cut = cutOut(picture, region, file);
        if (!cut)
            return cut.error();
        auto uri = makeUri(cut.value(), "png");
        if (!uri)
            return uri.error();
        parts.push_back(
            {{"x", region.x},
             {"y", region.y},
             {"width", region.width},
             {"height", region.height},
             {"uri", std::move(uri).value()}}
        );
    }
    return parts;
}

/// Every string under "image" or "errorMap", at any depth. Rows at equal time show less.
void collectWhole(const json& value, std::set<std::string>& paths) {
    if (value.is_object()) {
        for (const auto& [key, member] : value.items()) {
            if (member.is_string() && (key == "image" || key == "errorMap"))
                paths.insert(member.get<std::string>());
            else if (key != "equalTime")
                collectWhole(member, paths);
        }
    } else if (value.is_array()) {
        for (const json& member : value)
            collectWhole(member, paths);
    }
}

/// The text under `key`; empty where there is none.
std::string findText(const json& value, const char* key) {
    const auto found = value.is_object() ? value.find(key) : value.end();
    return found != value.end() && found->is_string() ? found->get<std::string>() : std::string();
}

/// The elements under `key`; none where that is no array.
const json& findArray(const json& value, const char* key) {
    static const json kNone = json::array();
    const auto found = value.is_object() ? value.find(key) : value.end();
    return found != value.end() && found->is_array() ? *found : kNone;
}

core::Result<PictureRegion> readCrop(const json& crop, const std::string& caseName) {
    constexpr std::array<const char*, 4> kFields = {"x", "y", "width", "height"};
    std::array<uint32_t, kFields.size()> values{};
    for (size_t i = 0; i < kFields.size(); ++i) {
        const auto found = crop.is_object() ? crop.find(kFields[i]) : crop.end();
        const double least = i < 2 ? 0.0 : 1.0;
        const bool isNumber = found != crop.end() && found->is_number_integer();
        const double value = isNumber ? found->get<double>() : -1.0;
        const bool isCount = value >= least && value <= std::numeric_limits<uint32_t>::max();
        if (!isCount)
            return core::makeError(
                "a crop of the case '{}' has no '{}' of {} or more", caseName, kFields[i], least
            );
        values[i] = uint32_t(value);
    }
    return PictureRegion{values[0], values[1], values[2], values[3]};
}

core::Result<Crops> readCrops(const json& theCase) {
    Crops crops;
    for (const json& one : findArray(theCase, "crops")) {
        const auto crop = readCrop(one, findText(theCase, "name"));
        if (!crop)
            return crop.error();
        crops.push_back(crop.value());
    }
    return crops;
}

void addCrops(const json& value, const Crops& crops, ShownPictures& shown) {
    if (const std::string path = findText(value, "image"); !path.empty() && !crops.empty())
        shown.crops[path] = crops;
}

/// Error: a crop is not four numbers above or equal to 0, or has no pixels.
core::Result<ShownPictures> findShownPictures(const json& results) {
    ShownPictures shown;
    collectWhole(results, shown.whole);
    std::map<std::string, Crops> cropsByCase;
    for (const json& theCase : findArray(results, "cases")) {
        auto crops = readCrops(theCase);
        if (!crops)
            return crops.error();
        if (theCase.is_object() && theCase.contains("truth"))
            addCrops(theCase.at("truth"), crops.value(), shown);
        for (const json& measurement : findArray(theCase, "measurements"))
            addCrops(measurement, crops.value(), shown);
        cropsByCase[findText(theCase, "name")] = std::move(crops.value());
    }
    for (const json& entry : findArray(results, "equalTime")) {
        const Crops& crops = cropsByCase[findText(entry, "case")];
        for (const json& row : findArray(entry, "rows")) {
            const std::string path = findText(row, "image");
            if (!path.empty() && !crops.empty() && !shown.whole.contains(path))
                shown.crops[path] = {crops.front()};
        }
    }
    return shown;
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

Result<json> encodePictures(const json& results, const fs::path& folder) {
    const auto shown = findShownPictures(results);
    if (!shown)
        return shown.error();
    json files = {{"whole", json::object()}, {"parts", json::object()}};
    for (const std::string& path : shown.value().whole) {
        const auto picture = readPng(folder, path);
        if (!picture)
            return picture.error();
        auto uri = makeUri(picture.value(), "jpg");
        if (!uri)
            return uri.error();
        files["whole"][path] = std::move(uri).value();
    }
    for (const auto& [path, regions] : shown.value().crops) {
        const auto picture = readPng(folder, path);
        if (!picture)
            return picture.error();
        auto parts = cutParts(picture.value(), regions, folder / path);
        if (!parts)
            return parts.error();
        files["parts"][path] = std::move(parts).value();
    }
    return files;
}

} // namespace shutter::bench
