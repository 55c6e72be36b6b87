// SPDX-License-Identifier: MIT
#include "engine/core/whole_file.h"
#include "tests/support/temp_folder.h"

#include <gtest/gtest.h>

#include <array>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <span>
#include <string>
#include <string_view>
#include <sys/stat.h>
#include <thread>
#include <unistd.h>

namespace shutter::core {

namespace {

namespace fs = std::filesystem;
using test::TempFolder;

std::string readText(const fs::path& path) {
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

Status writeText(const fs::path& path, std::string_view text) {
    return writeWholeFile(path, std::as_bytes(std::span(text)));
}

std::string reasonOf(const Status& status) {
    return status ? "" : status.error().message;
}

struct stat statusOf(const fs::path& path) {
    struct stat found {};

    EXPECT_EQ(::stat(path.c_str(), &found), 0) << path;
    return found;
}

unsigned modeOf(const fs::path& path) {
    return statusOf(path).st_mode & 07777U;
}

/// Puts the process's mask back.
class Umask {
  public:
    explicit Umask(mode_t mask) : mOld(::umask(mask)) {}

    ~Umask() { ::umask(mOld); }

    Umask(const Umask&) = delete;
    Umask& operator=(const Umask&) = delete;

  private:
    mode_t mOld;
};

} // namespace

TEST(WholeFile, ALinkStaysAndTheFileThatItNamesIsReplacedButForOtherHardLinks) {
    const TempFolder folder;
    fs::create_directory(folder.path() / "store");
    const fs::path real = folder.write("store/real.png", "old");
    fs::create_hard_link(real, folder.path() / "kept.png");
    const fs::path relative = folder.path() / "relative.png";
    const fs::path absolute = folder.path() / "absolute.png";
    const fs::path chain = folder.path() / "chain.png";
    fs::create_symlink("store/real.png", relative);
    fs::create_symlink(real, absolute);
    fs::create_symlink("relative.png", chain);
    for (const fs::path& link : {relative, absolute, chain}) {
        const std::string text = "through " + link.filename().string();
        ASSERT_TRUE(checkOutput(link)) << link;
        ASSERT_TRUE(writeText(link, text)) << link;
        EXPECT_TRUE(fs::is_symlink(link)) << link;
        EXPECT_FALSE(fs::is_symlink(real)) << link;
        EXPECT_EQ(readText(real), text);
    }
    EXPECT_EQ(readText(folder.path() / "kept.png"), "old");
    EXPECT_EQ(test::countFiles(folder.path()), 5u);
    EXPECT_EQ(test::countFiles(folder.path() / "store"), 1u) << "no temporary file is left";
}

TEST(WholeFile, ALinkToNothingMakesTheFileThatItNames) {
    const TempFolder folder;
    fs::create_symlink("missing.png", folder.path() / "link.png");
    ASSERT_TRUE(writeText(folder.path() / "link.png", "new"));
    EXPECT_TRUE(fs::is_symlink(folder.path() / "link.png"));
    EXPECT_EQ(readText(folder.path() / "missing.png"), "new");
}

TEST(WholeFile, FoldersAndPathsThatLeadNowhereAreRefusedInASentence) {
    const TempFolder folder;
    fs::create_directory(folder.path() / "inner");
    const std::array<std::array<const char*, 2>, 4> links{
        {{"inner", "folder"},
         {"nowhere/a.png", "lost.png"},
         {"b.png", "a.png"},
         {"a.png", "b.png"}}};
    for (const auto& [target, link] : links)
        fs::create_symlink(target, folder.path() / link);
    const std::array<std::array<const char*, 2>, 5> cases{
        {{"inner", "it is a folder"},
         {"folder", "it is a folder"},
         {"a.png", "its links lead in a circle"},
         {"lost.png", "nowhere' does not exist"},
         {"nowhere/a.png", "nowhere' does not exist"}}};
    for (const auto& [name, sentence] : cases) {
        const std::string reason = reasonOf(checkOutput(folder.path() / name));
        EXPECT_NE(reason.find(sentence), std::string::npos) << name << ": " << reason;
        EXPECT_FALSE(writeText(folder.path() / name, "x")) << name;
    }
    EXPECT_EQ(reasonOf(writeText(folder.path() / "inner", "x")), "it is a folder");
    EXPECT_EQ(reasonOf(writeText(folder.path() / "a.png", "x")), "its links lead in a circle");
    EXPECT_TRUE(fs::is_symlink(folder.path() / "a.png"));
    EXPECT_FALSE(writeText("", "x"));
}

TEST(WholeFile, AFileThatIsThereKeepsItsPermissionsAndANewOneHasThoseThatTheMaskLeaves) {
    const TempFolder folder;
    const fs::path file = folder.path() / "a.png";
    for (const auto& [mask, ofNew] :
         {std::pair<mode_t, unsigned>{0022, 0644}, {0077, 0600}, {0002, 0664}}) {
        const Umask set(mask);
        ASSERT_TRUE(writeText(file, "new"));
        EXPECT_EQ(modeOf(file), ofNew) << std::oct << mask;
        for (const unsigned mode : {0664u, 0600u, 0444u, 0755u}) {
            ASSERT_EQ(::chmod(file.c_str(), mode), 0);
            ASSERT_TRUE(writeText(file, "newer"));
            EXPECT_EQ(readText(file), "newer");
            EXPECT_EQ(modeOf(file), mode) << std::oct << mode << " under " << mask;
        }
        fs::remove(file);
    }
}

TEST(WholeFile, AFileThatIsThereKeepsItsOwnerWhereTheSystemPermits) {
    if (::geteuid() != 0)
        GTEST_SKIP() << "only root gives files away";
    const TempFolder folder;
    const fs::path file = folder.write("a.png", "old");
    constexpr uid_t kOther = 12345;
    ASSERT_EQ(::chown(file.c_str(), kOther, kOther), 0);
    ASSERT_TRUE(writeText(file, "new"));
    EXPECT_EQ(statusOf(file).st_uid, kOther);
    EXPECT_EQ(statusOf(file).st_gid, kOther);
}

TEST(WholeFile, ALinkToAnotherFileSystemIsReplacedThere) {
    const TempFolder folder;
    const fs::path shared = "/dev/shm";

    if (::access(shared.c_str(), W_OK) != 0 ||
        statusOf(folder.path()).st_dev == statusOf(shared).st_dev)
        GTEST_SKIP() << "there is no other file system to write to";
    const fs::path real = shared / folder.path().filename();
    fs::create_symlink(real, folder.path() / "link.png");
    ASSERT_TRUE(writeText(folder.path() / "link.png", "new"));
    EXPECT_TRUE(fs::is_symlink(folder.path() / "link.png"));
    EXPECT_EQ(readText(real), "new");
    fs::remove(real);
}

TEST(WholeFile, ALinkToAPipeOrADeviceIsWrittenTo) {
    const TempFolder folder;
    ASSERT_EQ(::mkfifo((folder.path() / "pipe").c_str(), 0600), 0);
    fs::create_symlink("pipe", folder.path() / "link.png");
    std::string received;
    std::thread reader([&] { received = readText(folder.path() / "pipe"); });
    const Status written = writeText(folder.path() / "link.png", "through the pipe");
    reader.join();
    EXPECT_TRUE(written) << reasonOf(written);
    EXPECT_EQ(received, "through the pipe");
    EXPECT_TRUE(fs::is_fifo(folder.path() / "pipe"));
    fs::create_symlink("/dev/null", folder.path() / "null.png");
    EXPECT_TRUE(checkOutput(folder.path() / "null.png"));
    EXPECT_TRUE(writeText(folder.path() / "null.png", "gone"));
    EXPECT_TRUE(fs::is_character_file("/dev/null"));
    EXPECT_NE(
        reasonOf(writeText("/dev/full", "much")).find("No space left on device"), std::string::npos
    );
}

// `--stats /dev/stdout > file`: the file must not be replaced, nor earlier output truncated.
TEST(WholeFile, AnOpenFileOfThisProcessIsWrittenWhereItStands) {
    const TempFolder folder;
    const fs::path file = folder.write("out.txt", "");
    const int descriptor = ::open(file.c_str(), O_WRONLY);
    ASSERT_GE(descriptor, 0);
    ASSERT_EQ(::write(descriptor, "printed ", 8), 8);
    const fs::path own = "/dev/fd/" + std::to_string(descriptor);
    fs::create_symlink(own, folder.path() / "link.json");
    EXPECT_TRUE(checkOutput(own));
    EXPECT_TRUE(writeText(own, "one "));
    EXPECT_TRUE(writeText(folder.path() / "link.json", "two"));
    ::close(descriptor);
    EXPECT_EQ(readText(file), "printed one two");
    EXPECT_FALSE(checkOutput(own)) << "it is closed";
    EXPECT_FALSE(writeText(own, "late"));
    EXPECT_EQ(test::countFiles(folder.path()), 2u);
}

} // namespace shutter::core
