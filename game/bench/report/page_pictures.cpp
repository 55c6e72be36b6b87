// SPDX-License-Identifier: MIT
#include "game/bench/report/page_pictures.h"

#include "engine/io/file_bytes.h"
#include "engine/io/image_file.h"
#include "engine/io/uri.h"
#include "game/bench/report/page_template.h"
#include "game/bench/report/shown_pictures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace shutter::bench {

namespace {

namespace fs = std::filesystem;
using core::Result;
using core::Status;
using nlohmann::json;
using Bytes = std::vector<uint8_t>;

constexpr uint64_t kMaxPictureBytes = 64ULL << 20;
constexpr uint32_t kMagmaColors = 256;
/// JPEG quality of parts, which are thumbnails, where whole pictures are JPEG.
constexpr int kPartQuality = 90;
constexpr size_t kNoLimit = std::numeric_limits<size_t>::max();

constexpr PictureDetail kDetails[] = {
    {0, true, 0},
    {80, true, 0},
    {80, false, kNoLimit},
    {60, false, kNoLimit},
    {60, false, 2},
    {60, false, 1},
    {40, false, 1},
    {20, false, 1},
    {20, false, 0},
};

std::string makeUri(const std::string& type, const Bytes& bytes) {
    return "data:image/" + type + ";base64," + encodeBase64(bytes);
}

/// Results may come from anybody; the page is to hold nothing from outside their folder.
Result<fs::path> findFile(const fs::path& folder, const std::string& path) {
    return io::resolveUri(folder, path);
}

Result<Bytes> readPng(const fs::path& file) {
    auto bytes = io::readFileBytes(file, kMaxPictureBytes + 1);
    if (!bytes)
        return bytes;
    constexpr std::array<uint8_t, 8> kPng = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
    const Bytes& data = bytes.value();
    if (data.size() < kPng.size() || !std::equal(kPng.begin(), kPng.end(), data.begin()))
        return core::makeError("'{}' is not a PNG", file.string());
    if (data.size() > kMaxPictureBytes)
        return core::makeError("'{}' is larger than 64 MiB", file.string());
    return bytes;
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

json describeRegion(const PictureRegion& region) {
    return {{"x", region.x}, {"y", region.y}, {"width", region.width}, {"height", region.height}};
}

Result<image::Image> readLinear(const fs::path& file) {
    auto picture = io::readImage(file);
    if (!picture)
        return picture;
    const std::vector<std::string>& names = picture.value().channelNames;
    for (const char* name : {"R", "G", "B"})
        if (std::find(names.begin(), names.end(), name) == names.end())
            return core::makeError("'{}' has no channel {}", file.string(), name);
    return picture;
}

/// Rounds errors to as many steps as there are colours for them: no reader sees finer ones, and
/// they take a third of the bytes.
void roundErrors(image::Image& picture) {
    const auto found = std::find(picture.channelNames.begin(), picture.channelNames.end(), "flip");
    if (found == picture.channelNames.end())
        return;
    constexpr auto kSteps = float(kMagmaColors);
    for (size_t i = size_t(found - picture.channelNames.begin()); i < picture.pixels.size();
         i += picture.channels)
        picture.pixels[i] = std::round(picture.pixels[i] * kSteps) / kSteps;
}

/// Puts the pictures together at one detail, until they are too large.
class Encoder {
  public:
    Encoder(const fs::path& folder, const PictureDetail& detail, size_t budgetBytes)
        : mFolder(folder), mDetail(detail), mBudgetBytes(budgetBytes) {
        mWhole = json::object();
        mParts = json::object();
    }

    Status encode(const ShownPictures& shown) {
        for (const auto& [path, region] : shown.parts)
            if (fits())
                SHUTTER_TRY(addPart(path, region));
        for (const auto& [path, crops] : shown.linear)
            if (fits())
                SHUTTER_TRY(addLinear(path, crops));
        for (const std::string& path : shown.whole)
            if (fits())
                SHUTTER_TRY(addWhole(path));
        return {};
    }

    [[nodiscard]] bool fits() const { return mBytes <= mBudgetBytes; }

    PagePictures take() {
        json detail = {{"linearWhole", mDetail.isLinearWhole}};
        detail["jpegQuality"] = mDetail.jpegQuality > 0 ? json(mDetail.jpegQuality) : json();
        return {
            mDetail,
            mBytes,
            {{"whole", std::move(mWhole)},
             {"parts", std::move(mParts)},
             {"detail", std::move(detail)}}};
    }

  private:
    Status addWhole(const std::string& path) {
        const auto file = findFile(mFolder, path);
        if (!file)
            return file.error();
        const auto png = readPng(file.value());
        if (!png)
            return png.error();
        if (mDetail.jpegQuality == 0) {
            keep(mWhole[path], makeUri("png", png.value()));
            return {};
        }
        const auto picture = io::readImage(file.value());
        if (!picture)
            return picture.error();
        const auto jpeg = io::encodeImage(
            "picture.jpg", picture.value(), io::SampleType::Float, mDetail.jpegQuality
        );
        if (!jpeg)
            return jpeg.error();
        keep(mWhole[path], makeUri("jpeg", jpeg.value()));
        return {};
    }

    Status addPart(const std::string& path, const PictureRegion& region) {
        const auto file = findFile(mFolder, path);
        if (!file)
            return file.error();
        if (const auto png = readPng(file.value()); !png)
            return png.error();
        const auto picture = io::readImage(file.value());
        if (!picture)
            return picture.error();
        const char* format = mDetail.jpegQuality == 0 ? "png" : "jpeg";
        return addRegion(path, picture.value(), region, file.value(), format);
    }

    Status addLinear(const std::string& path, const std::vector<PictureRegion>& crops) {
        const size_t count = std::min(crops.size(), mDetail.linearCropCount);
        if (count == 0 && !mDetail.isLinearWhole)
            return {};
        const auto file = findFile(mFolder, path);
        if (!file)
            return file.error();
        auto picture = readLinear(file.value());
        if (!picture)
            return picture.error();
        roundErrors(picture.value());
        const PictureRegion all{0, 0, picture.value().width, picture.value().height};
        const std::vector<PictureRegion> regions =
            mDetail.isLinearWhole
                ? std::vector{all}
                : std::vector(crops.begin(), crops.begin() + std::ptrdiff_t(count));
        for (const PictureRegion& region : regions)
            SHUTTER_TRY(addRegion(path, picture.value(), region, file.value(), "exr"));
        return {};
    }

    /// \param format "exr", "png" or "jpeg"
    Status addRegion(
        const std::string& path,
        const image::Image& picture,
        const PictureRegion& region,
        const fs::path& file,
        const std::string& format
    ) {
        const auto cut = cutOut(picture, region, file);
        if (!cut)
            return cut.error();
        const auto bytes =
            io::encodeImage("picture." + format, cut.value(), io::SampleType::Half, kPartQuality);
        if (!bytes)
            return bytes.error();
        json part = describeRegion(region);
        if (format == "exr")
            keep(part["exr"], encodeBase64(bytes.value()));
        else
            keep(part["uri"], makeUri(format, bytes.value()));
        mParts[path].push_back(std::move(part));
        return {};
    }

    void keep(json& place, std::string text) {
        mBytes += text.size();
        place = std::move(text);
    }

    const fs::path& mFolder;
    PictureDetail mDetail;
    size_t mBudgetBytes;
    size_t mBytes = 0;
    json mWhole;
    json mParts;
};

/// The error maps' colours, so that the page paints errors as their files do.
std::string packMagma() {
    image::Image steps(kMagmaColors, 1, 1);
    for (uint32_t i = 0; i < kMagmaColors; ++i)
        steps.pixels[i] = float(i) / float(kMagmaColors - 1);
    const image::Image colors = image::colorWithMagma(steps);
    Bytes bytes;
    for (const float value : colors.pixels)
        bytes.push_back(uint8_t(std::lround(value * 255.0f)));
    return encodeBase64(bytes);
}

} // namespace

std::span<const PictureDetail> listPictureDetails() {
    return kDetails;
}

Result<PagePictures>
encodePictures(const json& results, const fs::path& folder, size_t budgetBytes) {
    const auto shown = findShownPictures(results);
    if (!shown)
        return shown.error();
    std::optional<PagePictures> encoded;
    for (const PictureDetail& detail : kDetails) {
        const bool isLast = &detail == std::end(kDetails) - 1;
        Encoder encoder(folder, detail, isLast ? kNoLimit : budgetBytes);
        SHUTTER_TRY(encoder.encode(shown.value()));
        if (!encoder.fits())
            continue;
        encoded = encoder.take();
        break;
    }
    encoded->files["magma"] = packMagma();
    return std::move(*encoded);
}

} // namespace shutter::bench
