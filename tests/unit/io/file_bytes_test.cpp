// SPDX-License-Identifier: MIT
#include "engine/io/file_bytes.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

namespace shutter::io {

namespace {

namespace fs = std::filesystem;

class FileBytes : public testing::Test {
  protected:
    FileBytes() {
        const auto* test = testing::UnitTest::GetInstance()->current_test_info();
        mFolder = fs::path(testing::TempDir()) / (std::string("file_bytes_") + test->name());
        fs::remove_all(mFolder);
        fs::create_directories(mFolder);
    }

    ~FileBytes() override { fs::remove_all(mFolder); }

    [[nodiscard]] size_t countFiles() const {
        size_t count = 0;
        for ([[maybe_unused]] const auto& entry : fs::directory_iterator(mFolder))
            ++count;
        return count;
    }

    fs::path mFolder;
};

std::string readText(const fs::path& path) {
    const auto bytes = readFileBytes(path, 1 << 20);
    return bytes ? std::string(bytes.value().begin(), bytes.value().end()) : std::string("none");
}

} // namespace

TEST_F(FileBytes, WhatIsWrittenIsReadAgainAndNothingElseIsLeft) {
    const std::string text("a\0b\n", 4);
    ASSERT_TRUE(writeFileText(mFolder / "x.txt", text).ok());
    EXPECT_EQ(readText(mFolder / "x.txt"), text);
    ASSERT_TRUE(writeFileText(mFolder / "x.txt", "").ok());
    EXPECT_EQ(readText(mFolder / "x.txt"), "");
    EXPECT_EQ(countFiles(), 1u);
}

TEST_F(FileBytes, AFolderThatIsMissingIsNamedAndNotMade) {
    const fs::path path = mFolder / "missing" / "x.txt";
    const core::Status written = writeFileText(path, "x");
    ASSERT_FALSE(written.ok());
    EXPECT_NE(written.error().message.find(path.string()), std::string::npos);
    EXPECT_EQ(countFiles(), 0u);
}

TEST_F(FileBytes, AFolderInTheWayStaysAndLeavesNoTemporary) {
    fs::create_directories(mFolder / "x.txt" / "inside");
    ASSERT_FALSE(writeFileText(mFolder / "x.txt", "x").ok());
    EXPECT_TRUE(fs::is_directory(mFolder / "x.txt"));
    EXPECT_EQ(countFiles(), 1u);
}

} // namespace shutter::io
