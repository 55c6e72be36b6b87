// SPDX-License-Identifier: MIT
#include "game/play/loop/numbered_file.h"

#include <gtest/gtest.h>

#include <fstream>

namespace shutter::game {
namespace {

namespace fs = std::filesystem;

TEST(NumberedFile, TheFirstFreeNumberIsTakenAndItsAbsenceIsReported) {
    const fs::path folder = fs::path(testing::TempDir()) / "numbered_file";
    fs::remove_all(folder);
    fs::create_directories(folder);
    const auto take = [&] {
        auto file = findFreeFile(folder, "rally_truth", ".png");
        if (file)
            std::ofstream(file.value()) << "x";
        return file;
    };
    EXPECT_EQ(take().value().filename(), "rally_truth_001.png");
    EXPECT_EQ(take().value().filename(), "rally_truth_002.png");
    const fs::path soon[] = {folder / "rally_truth_003.png"};
    EXPECT_EQ(
        findFreeFile(folder, "rally_truth", ".png", soon).value().filename(), "rally_truth_004.png"
    );
    fs::remove(folder / "rally_truth_001.png");
    EXPECT_EQ(take().value().filename(), "rally_truth_001.png");
    for (int i = 3; i <= 999; ++i)
        ASSERT_TRUE(take()) << i;
    const auto none = take();
    ASSERT_FALSE(none);
    EXPECT_NE(none.error().message.find("999 files rally_truth_NNN.png"), std::string::npos)
        << none.error().message;
    fs::remove_all(folder);
}

} // namespace
} // namespace shutter::game
