// SPDX-License-Identifier: MIT
#include "engine/io/file_bytes.h"
#include "tests/support/temp_folder.h"

#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <string>
#include <sys/resource.h>
#include <sys/stat.h>
#include <thread>

namespace shutter::io {

namespace {

using test::TempFolder;

namespace fs = std::filesystem;

std::vector<uint8_t> toBytes(const std::string& text) {
    return {text.begin(), text.end()};
}

std::string readText(const fs::path& path) {
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

} // namespace

TEST(FileBytes, AWrittenFileHoldsTheBytesAndNothingElseIsLeft) {
    const TempFolder folder;
    const fs::path path = folder.path() / "a.json";
    for (const std::string text : {"first, and longer", "second", ""}) {
        const core::Status written = writeFileBytes(path, toBytes(text));
        ASSERT_TRUE(written) << written.error().message;
        EXPECT_EQ(readText(path), text);
        EXPECT_EQ(test::countFiles(folder.path()), 1u);
    }
}

TEST(FileBytes, AWriteThatFailsNamesTheFileAndLeavesTheOldOne) {
    const TempFolder folder;
    const fs::path path = folder.path() / "a.json";
    ASSERT_TRUE(writeFileBytes(path, toBytes("old")));
    // No file may grow beyond 100 bytes.
    rlimit old{};
    ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &old), 0);
    const auto oldHandler = std::signal(SIGXFSZ, SIG_IGN);
    const rlimit tight{100, old.rlim_max};
    ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &tight), 0);
    const core::Status written = writeFileBytes(path, std::vector<uint8_t>(100000, 'x'));
    ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &old), 0);
    std::signal(SIGXFSZ, oldHandler);
    ASSERT_FALSE(written);
    EXPECT_NE(written.error().message.find(path.string()), std::string::npos);
    EXPECT_EQ(readText(path), "old");
    EXPECT_EQ(test::countFiles(folder.path()), 1u);
}

TEST(FileBytes, AFolderIsNeitherWrittenNorReplaced) {
    const TempFolder folder;
    const fs::path inner = folder.path() / "inner";
    fs::create_directory(inner);
    for (const fs::path& path : {inner, folder.path() / "missing" / "a.json"}) {
        const core::Status written = writeFileBytes(path, toBytes("text"));
        ASSERT_FALSE(written);
        EXPECT_NE(written.error().message.find(path.string()), std::string::npos);
    }
    EXPECT_TRUE(fs::is_directory(inner));
    EXPECT_EQ(test::countFiles(folder.path()), 1u);
}

TEST(FileBytes, APipeIsWrittenToAndStaysAPipe) {
    const TempFolder folder;
    const fs::path path = folder.path() / "pipe";
    ASSERT_EQ(::mkfifo(path.c_str(), 0600), 0);
    std::string received;
    std::thread reader([&] { received = readText(path); });
    const core::Status written = writeFileBytes(path, toBytes("through the pipe"));
    reader.join();
    EXPECT_TRUE(written);
    EXPECT_EQ(received, "through the pipe");
    EXPECT_TRUE(fs::is_fifo(path));
    EXPECT_EQ(test::countFiles(folder.path()), 1u);
}

TEST(ContentHash, IsThirtyTwoDigitsAndChangesWithEachByte) {
    std::set<std::string> seen;
    const std::string base(200, 'a');
    for (size_t i = 0; i <= base.size(); ++i) {
        std::string changed = base;
        if (i < base.size())
            changed[i] = 'b';
        const std::string hash = computeContentHash(changed);
        EXPECT_EQ(hash.size(), 32u);
        EXPECT_EQ(hash.find_first_not_of("0123456789abcdef"), std::string::npos);
        seen.insert(hash);
    }
    EXPECT_EQ(seen.size(), base.size() + 1);
    EXPECT_NE(computeContentHash(""), computeContentHash(std::string(1, '\0')));
}

TEST(ContentHash, OfAFileIsThatOfItsBytes) {
    const test::TempFolder folder;
    const std::string bytes("x\0y", 3);
    const auto hash = computeFileHash(folder.write("a.bin", bytes));
    ASSERT_TRUE(hash.ok());
    EXPECT_EQ(hash.value(), computeContentHash(bytes));
}

TEST(ContentHash, AMissingFileIsNamed) {
    const auto hash = computeFileHash("no/such/file");
    ASSERT_FALSE(hash.ok());
    EXPECT_NE(hash.error().message.find("no/such/file"), std::string::npos);
}

} // namespace shutter::io
