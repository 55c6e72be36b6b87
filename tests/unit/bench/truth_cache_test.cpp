// SPDX-License-Identifier: MIT
#include "engine/io/image_file.h"
#include "game/bench/truth_cache.h"
#include "tests/support/temp_folder.h"

#include <gtest/gtest.h>

#include <string>

namespace shutter::bench {
namespace {

TEST(CachedTruth, IsTakenWhereItIsAPictureOfTheCasesSize) {
    const test::TempFolder folder;
    const auto file = folder.path() / "truth.png";
    EXPECT_FALSE(readCachedTruth("", 4, 3));
    EXPECT_FALSE(readCachedTruth(file, 4, 3));
    ASSERT_TRUE(io::writeImage(file, image::Image(4, 3, 3)));
    const auto truth = readCachedTruth(file, 4, 3);
    ASSERT_TRUE(truth);
    EXPECT_EQ(truth->pixels.size(), 36u);
}

TEST(CachedTruth, AnythingElseCountsAsNoneAndIsNamed) {
    const test::TempFolder folder;
    const auto expectNone = [](const std::filesystem::path& file, const char* mention) {
        testing::internal::CaptureStderr();
        EXPECT_FALSE(readCachedTruth(file, 4, 3)) << file;
        const std::string told = testing::internal::GetCapturedStderr();
        EXPECT_NE(told.find(file.filename().string()), std::string::npos) << told;
        EXPECT_NE(told.find(mention), std::string::npos) << told;
    };
    expectNone(folder.write("damaged.png", "\x89PNG\r\n\x1A\n..."), "cannot read");
    ASSERT_TRUE(io::writeImage(folder.path() / "size.png", image::Image(5, 3, 3)));
    expectNone(folder.path() / "size.png", "is 5x3");
    ASSERT_TRUE(io::writeImage(folder.path() / "grey.png", image::Image(4, 3, 1)));
    expectNone(folder.path() / "grey.png", "with 1 channels");
    std::filesystem::create_directory(folder.path() / "folder.png");
    expectNone(folder.path() / "folder.png", "it is not a file");
}

} // namespace
} // namespace shutter::bench
