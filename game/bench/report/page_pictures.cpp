// SPDX-License-Identifier: MIT
#include "engine/io/file_bytes.h"
#include "engine/io/image_file.h"
#include "engine/io/uri.h"
#include "game/bench/report/page_media.h"
#include "game/bench/report/page_template.h"
#include "game/bench/report/shown_pictures.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <string>
#include <utility>
#include <vector>

namespace shutter::bench {

namespace {

namespace fs = std::filesystem;
using core::Result;
using nlohmann::json;
using Bytes = std::vector<uint8_t>;

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

} // namespace

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
