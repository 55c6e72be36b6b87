// SPDX-License-Identifier: MIT
#include "game/output/extra_files.h"
#include "tests/support/temp_folder.h"

#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <iterator>
#include <sys/resource.h>

namespace shutter::game {

TEST(StatisticsFile, AFileThatCannotBeFinishedLeavesTheOldOneAndNothingElse) {
    const test::TempFolder folder;
    const std::filesystem::path path = folder.path() / "stats.json";
    RenderOptions options;
    options.method.method = findMethod("sharp").value();
    ASSERT_TRUE(writeStatistics(path, options, {}, {{0.0, {}}}).ok());
    const auto size = std::filesystem::file_size(path);
    // No file may grow beyond 100 bytes.
    rlimit old{};
    ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &old), 0);
    const auto oldHandler = std::signal(SIGXFSZ, SIG_IGN);
    const rlimit tight{100, old.rlim_max};
    ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &tight), 0);
    const core::Status written = writeStatistics(path, options, {}, {{0.0, {}}});
    ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &old), 0);
    std::signal(SIGXFSZ, oldHandler);
    ASSERT_FALSE(written.ok());
    EXPECT_NE(written.error().message.find("--stats"), std::string::npos);
    EXPECT_NE(written.error().message.find(path.string()), std::string::npos);
    EXPECT_EQ(std::filesystem::file_size(path), size);
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
}

} // namespace shutter::game
