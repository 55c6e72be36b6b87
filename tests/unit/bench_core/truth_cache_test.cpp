// SPDX-License-Identifier: MIT
#include "engine/io/image_file.h"
#include "game/bench/truth_cache.h"
#include "tests/support/temp_folder.h"

#include <gtest/gtest.h>

#include <string>

namespace shutter::bench {
namespace {

TEST(CachedTruth, IsTakenWhereBothPicturesAreOfTheCasesSize) {
    const test::TempFolder folder;
    const TruthFiles files = nameTruthFiles(folder.path(), "truth");
    EXPECT_FALSE(readCachedTruth(nameTruthFiles("", "truth"), 4, 3));
    EXPECT_FALSE(readCachedTruth(files, 4, 3));
    TruthPictures drawn{image::Image(4, 3, 3), image::Image(4, 3, 3)};
    drawn.linear.at(3, 2, 1) = 40.5f;
    ASSERT_TRUE(writeTruth(files, drawn));
    const auto truth = readCachedTruth(files, 4, 3);
    ASSERT_TRUE(truth);
    EXPECT_EQ(truth->display.pixels.size(), 36u);
    EXPECT_EQ(truth->linear.at(3, 2, 1), 40.5f);
    // One without the other is what a run leaves that was killed between them.
    std::filesystem::remove(files.linear);
    EXPECT_FALSE(readCachedTruth(files, 4, 3));
}

TEST(CachedTruth, AnythingElseCountsAsNoneAndIsNamed) {
    const test::TempFolder folder;
    const TruthFiles files = nameTruthFiles(folder.path(), "truth");
    const image::Image good(4, 3, 3);
    const auto expectNone = [&](const std::filesystem::path& file, const char* mention) {
        testing::internal::CaptureStderr();
        EXPECT_FALSE(readCachedTruth(files, 4, 3)) << file;
        const std::string told = testing::internal::GetCapturedStderr();
        EXPECT_NE(told.find(file.filename().string()), std::string::npos) << told;
        EXPECT_NE(told.find(mention), std::string::npos) << told;
    };
    for (const std::filesystem::path& file : {files.display, files.linear}) {
        ASSERT_TRUE(writeTruth(files, {good, good}));
        std::ignore = folder.write(file.filename().string(), "\x89PNG\r\n\x1A\n...");
        expectNone(file, "cannot read");
        ASSERT_TRUE(io::writeImage(file, image::Image(5, 3, 3)));
        expectNone(file, "is 5x3");
        ASSERT_TRUE(io::writeImage(file, image::Image(4, 3, 1)));
        expectNone(file, "with 1 channel,");
        std::filesystem::remove(file);
        std::filesystem::create_directory(file);
        expectNone(file, "it is not a file");
        std::filesystem::remove(file);
    }
}

} // namespace
} // namespace shutter::bench
