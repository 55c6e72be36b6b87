// SPDX-License-Identifier: MIT
// Films that ffmpeg really encodes; each test skips where it is missing or lacks the codec.
#include "engine/image/image.h"
#include "engine/io/file_bytes.h"
#include "engine/io/image_file.h"
#include "engine/io/video.h"
#include "tests/support/temp_folder.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <random>

namespace shutter::io {
namespace {

using test::TempFolder;

constexpr uint32_t kFrames = 24;

/// Frames of noise, which no encoder makes small for nothing.
VideoFrames writeNoise(const std::filesystem::path& folder) {
    std::mt19937 random(7);
    image::Image picture(160, 96, 3);
    for (uint32_t i = 0; i < kFrames; ++i) {
        for (float& value : picture.pixels)
            value = float(random() % 256) / 255.0f;
        const auto file = folder / fmt::format("frame_{:06}.png", i);
        EXPECT_TRUE(writeImage(file, picture).ok());
    }
    return {folder, "frame_%06d.png", kFrames, double(kFrames)};
}

TEST(Video, AFilmOfAGivenRateKeepsNearIt) {
    const TempFolder folder;
    auto encoder = findVideoEncoder("", {VideoCodec::Vp9, 8, "", 0});
    if (!encoder)
        GTEST_SKIP() << encoder.error().message;
    const VideoFrames frames = writeNoise(folder.path());
    const auto encode = [&](uint32_t kilobits, const char* name) {
        encoder.value().format.kilobits = kilobits;
        const auto file = folder.path() / name;
        const core::Status done = encodeVideo(encoder.value(), frames, file);
        EXPECT_TRUE(done.ok()) << done.error().message;
        return double(std::filesystem::file_size(file)) * 8.0 / 1000.0; // of the film's one second
    };
    const double free = encode(0, "free.webm");
    const double held = encode(500, "held.webm");
    EXPECT_GT(free, 1500.0) << "the bound has something to hold";
    EXPECT_LT(held, 1000.0);
    EXPECT_GT(held, 100.0);
}

TEST(Video, AFilmForBrowsersIsWebM) {
    const TempFolder folder;
    const auto encoder = findVideoEncoder("", {VideoCodec::Vp9, 8, "", 200});
    if (!encoder)
        GTEST_SKIP() << encoder.error().message;
    const auto file = folder.path() / "film.webm";
    ASSERT_TRUE(encodeVideo(encoder.value(), writeNoise(folder.path()), file).ok());
    const auto bytes = readFileBytes(file, 64);
    ASSERT_TRUE(bytes.ok());
    const std::string head(bytes.value().begin(), bytes.value().end());
    EXPECT_TRUE(head.starts_with("\x1A\x45\xDF\xA3")) << "EBML";
    EXPECT_NE(head.find("webm"), std::string::npos);
}

} // namespace
} // namespace shutter::io
