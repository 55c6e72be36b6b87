// SPDX-License-Identifier: MIT
#include "game/bench/truth_cache.h"

#include "engine/core/log.h"
#include "engine/core/words.h"
#include "engine/io/image_file.h"

#include <system_error>
#include <utility>

namespace shutter::bench {

namespace {

std::optional<image::Image>
readPart(const std::filesystem::path& file, uint32_t width, uint32_t height) {
    constexpr uint32_t kChannels = 3;
    std::error_code ignored;
    if (file.empty() || !std::filesystem::exists(file, ignored))
        return std::nullopt;
    auto read = io::readImage(file);
    if (!read) {
        core::logWarning("{}; the truth is drawn again", read.error().message);
        return std::nullopt;
    }
    const image::Image& truth = read.value();
    if (truth.width == width && truth.height == height && truth.channels == kChannels)
        return std::move(read).value();
    core::logWarning(
        "'{}' is {}x{} with {}, not {}x{} with {}; the truth is drawn again",
        file.string(),
        truth.width,
        truth.height,
        core::countOf(truth.channels, "channel"),
        width,
        height,
        kChannels
    );
    return std::nullopt;
}

} // namespace

TruthFiles nameTruthFiles(const std::filesystem::path& folder, const std::string& name) {
    return folder.empty() ? TruthFiles()
                          : TruthFiles{folder / (name + ".png"), folder / (name + ".exr")};
}

std::optional<TruthPictures>
readCachedTruth(const TruthFiles& files, uint32_t width, uint32_t height) {
    auto display = readPart(files.display, width, height);
    auto linear = display ? readPart(files.linear, width, height) : std::nullopt;
    if (!linear)
        return std::nullopt;
    return TruthPictures{std::move(*display), std::move(*linear)};
}

core::Status writeTruth(const TruthFiles& files, const TruthPictures& truth) {
    SHUTTER_TRY(io::writeImage(files.display, truth.display));
    return io::writeImage(files.linear, truth.linear, io::SampleType::Half);
}

} // namespace shutter::bench
