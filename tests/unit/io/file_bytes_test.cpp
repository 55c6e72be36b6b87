// SPDX-License-Identifier: MIT
// Whole files, URIs, films and other programs.
#include "engine/image/image.h"
#include "engine/io/file_bytes.h"
#include "engine/io/image_file.h"
#include "engine/io/process.h"
#include "engine/io/uri.h"
#include "engine/io/video.h"
#include "tests/support/outcomes.h"
#include "tests/support/rows.h"
#include "tests/support/temp_folder.h"

#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <set>
#include <string>
#include <sys/resource.h>
#include <sys/stat.h>

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

TEST(ContentHash, HashesHaveThirtyTwoDigitsAndChangeWithEachByte) {
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

TEST(ContentHash, TheHashOfAFileIsThatOfItsBytesAndAMissingFileIsNamed) {
    const TempFolder folder;
    const std::string bytes("x\0y", 3);
    const std::string hash = test::valueOf(computeFileHash(folder.write("a.bin", bytes)));
    EXPECT_EQ(hash, computeContentHash(bytes));
    test::expectRefused(computeFileHash("no/such/file"), "no/such/file");
}

std::string decodeText(std::string_view uri) {
    const auto bytes = decodeDataUri(uri);
    return bytes ? std::string(bytes.value().begin(), bytes.value().end()) : "refused";
}

TEST(DataUri, DataOfEveryPaddingTypeAndParameterIsDecoded) {
    EXPECT_EQ(decodeText("data:application/octet-stream;base64,"), "");
    EXPECT_EQ(decodeText("data:;base64,Zg=="), "f");
    EXPECT_EQ(decodeText("data:;base64,Zm8="), "fo");
    EXPECT_EQ(decodeText("data:;base64,Zm9v"), "foo");
    EXPECT_EQ(decodeText("data:;base64,Zm9vYg"), "foob") << "without padding";
    EXPECT_EQ(decodeText("data:,a%20b%2C"), "a b,");
    EXPECT_EQ(decodeText("data:image/svg+xml;charset=utf-8;BASE64,Zg=="), "f");
    EXPECT_EQ(decodeText("data:;charset=utf-8,a"), "a");
    EXPECT_EQ(decodeText("data:;name=a%20b;base64,Zg%3D%3D"), "f");
}

TEST(DataUri, MalformedDataUrisAreRefused) {
    for (const std::string& header : test::rowsOf(
             ";|;;base64|;base64;|;base64;charset=utf-8|;base64;base64|;base65|;charset|;=utf-8|"
             ";charset=|;charset=a=b|;charset=utf 8;base64|base64|text;base64|text/;base64|"
             "/plain;base64|text/plain/more;base64| ;base64"
         ))
        EXPECT_EQ(decodeText("data:" + header + ",Zg=="), "refused") << header;
    // Padding that fills no group, bits after the last byte, no base64 digit, one digit too many.
    for (const std::string& data :
         test::rowsOf("Zg=|Zg===|Zm8==|Zm9v=|Zm9v====|Z===|=|Z=g=|Zh==|Zm9*|Zm9vY"))
        EXPECT_EQ(decodeText("data:;base64," + data), "refused") << data;
    for (const char* uri : {"data:;base64", "data:,%4", "http://x,y"})
        EXPECT_EQ(decodeText(uri), "refused") << uri;
}

TEST(ResolveUri, PlainNamesSpacesAndUnicodeStayInTheFolder) {
    const TempFolder folder;
    EXPECT_EQ(resolveUri(folder.path(), "a.bin").value(), folder.path() / "a.bin");
    EXPECT_EQ(resolveUri(folder.path(), "sub/a%20b.png").value(), folder.path() / "sub/a b.png");
    EXPECT_EQ(resolveUri(folder.path(), "a b.png").value(), folder.path() / "a b.png");
    EXPECT_EQ(resolveUri(folder.path(), "%E2%9D%A4.png").value(), folder.path() / "\u2764.png");
    EXPECT_EQ(resolveUri(folder.path(), "..a/b..").value(), folder.path() / "..a/b..");
}

TEST(ResolveUri, StepsThatStayInTheFolderAreResolvedInTheText) {
    const TempFolder folder;
    const TempFolder outside;
    folder.write("sub/deep/a.bin", "x");
    fs::create_symlink(outside.path(), folder.path() / "out");
    for (const std::string& uri : test::rowsOf(
             "a.bin|./a.bin|.//./a.bin|sub/../a.bin|sub/./../a.bin|sub/deep/../../a.bin|"
             "sub/../sub/deep/../../a.bin|sub/%2e%2e/a.bin|sub%2F..%2Fa.bin|no/such/../../a.bin|"
             "out/../a.bin"
         ))
        for (const Reach reach : {Reach::Folder, Reach::Anywhere}) {
            const fs::path file = test::valueOf(resolveUri(folder.path(), uri, reach));
            EXPECT_EQ(file, folder.path() / "a.bin") << uri;
        }
    EXPECT_EQ(resolveUri("", "sub/../a.bin").value(), "./a.bin");
}

TEST(ResolveUri, UnsafeUrisAreRefusedAndEndlessOnesShortenedInTheMessage) {
    const TempFolder folder;
    for (const std::string& uri : test::rowsOf(
             "|../a.bin|..|./../a.bin|sub/../../a.bin|sub/deep/../../../a.bin|"
             "sub/%2e%2e/%2E%2E/a.bin|sub\\..\\a.bin|sub/..\\a.bin|%2e%2e/a.bin|..%2fa.bin|"
             "..\\a.bin|/etc/hostname|%2Fetc/hostname|file:///etc/hostname|FILE:a.bin|"
             "http://127.0.0.1/a.bin|C:/a.bin|a%zz.bin|a%2|a%00.bin"
         ))
        EXPECT_FALSE(resolveUri(folder.path(), uri)) << uri;
    const auto endless = resolveUri(folder.path(), std::string(100000, 'a'));
    ASSERT_FALSE(endless);
    EXPECT_LT(endless.error().message.size(), 200u);
}

TEST(ResolveUri, ALinkOutOfTheFolderIsRefusedAndOneInsideIsFollowed) {
    const TempFolder outside;
    outside.write("secret.bin", "x");
    const TempFolder folder;
    folder.write("real.bin", "x");
    fs::create_symlink(outside.path() / "secret.bin", folder.path() / "out.bin");
    fs::create_symlink("real.bin", folder.path() / "in.bin");
    EXPECT_FALSE(resolveUri(folder.path(), "out.bin"));
    EXPECT_FALSE(resolveUri(folder.path(), "sub/../out.bin"));
    EXPECT_TRUE(resolveUri(folder.path(), "in.bin"));
}

TEST(ResolveUri, PathsThatLeaveTheFolderAreTakenFromThoseWhoMayAndSchemesFromNobody) {
    const TempFolder folder;
    const auto resolve = [&](std::string_view uri) {
        return resolveUri(folder.path(), uri, Reach::Anywhere);
    };
    EXPECT_EQ(resolve("../a.bin").value(), folder.path() / "../a.bin");
    EXPECT_EQ(resolve("/etc/hostname").value(), "/etc/hostname");
    for (const char* uri : {"file:///etc/hostname", "http://127.0.0.1/a.bin", "a%00.bin", ""})
        EXPECT_FALSE(resolve(uri)) << uri;
}

TEST(LiesInside, LinksAndStepsAreFollowed) {
    const TempFolder outside;
    const TempFolder folder;
    folder.write("sub/a.bin", "x");
    fs::create_symlink(outside.path(), folder.path() / "out");
    for (const char* inside : {"a", "sub/a.bin", "sub/../b", "no/such/folder"})
        EXPECT_TRUE(liesInside(folder.path(), inside)) << inside;
    EXPECT_TRUE(liesInside(folder.path(), folder.path() / "a"));
    for (const char* away : {"..", "sub/../../a", "out/a", "/etc/hostname"})
        EXPECT_FALSE(liesInside(folder.path(), away)) << away;
    EXPECT_TRUE(liesInside("", "a"));
    EXPECT_FALSE(liesInside("", "../a"));
}

constexpr uint32_t kFrames = 24;

/// Frames of noise, which no encoder makes small for nothing.
VideoFrames writeNoise(const std::filesystem::path& folder) {
    std::mt19937 random(7);
    image::Image picture(160, 96, 3);
    for (uint32_t i = 0; i < kFrames; ++i) {
        for (float& value : picture.pixels)
            value = float(random() % 256) / 255.0f;
        EXPECT_TRUE(writeImage(folder / fmt::format("frame_{:06}.png", i), picture).ok());
    }
    return {folder, "frame_%06d.png", kFrames, double(kFrames)};
}

TEST(Video, AFilmOfAGivenRateKeepsNearItAndOneForBrowsersIsWebM) {
    const TempFolder folder;
    auto encoder = findVideoEncoder("", {VideoCodec::Vp9, 8, "", 0});
    if (!encoder)
        GTEST_SKIP() << encoder.error().message;
    const VideoFrames frames = writeNoise(folder.path());
    const auto encode = [&](uint32_t kilobits, const char* name) {
        encoder.value().format.kilobits = kilobits;
        const auto file = folder.path() / name;
        test::expectDone(encodeVideo(encoder.value(), frames, file));
        return double(std::filesystem::file_size(file)) * 8.0 / 1000.0; // of the film's one second
    };
    const double free = encode(0, "free.webm");
    const double held = encode(500, "held.webm");
    EXPECT_GT(free, 1500.0) << "the bound has something to hold";
    EXPECT_LT(held, 1000.0);
    EXPECT_GT(held, 100.0);
    const std::string head = readText(folder.path() / "held.webm").substr(0, 64);
    EXPECT_TRUE(head.starts_with("\x1A\x45\xDF\xA3")) << "EBML";
    EXPECT_NE(head.find("webm"), std::string::npos);
}

ProcessResult shell(const std::string& script, const std::filesystem::path& folder = ".") {
    return test::valueOf(runProcess("/bin/sh", {"-c", script}, folder));
}

TEST(Process, BothStreamsAndTheExitStatusAreReturned) {
    const ProcessResult result = shell("echo out; echo err >&2; cat; exit 7");
    EXPECT_EQ(result.output, "out\n") << "nothing is on its stdin";
    EXPECT_EQ(result.errors, "err\n");
    EXPECT_EQ(result.exitStatus, 7);
    EXPECT_EQ(shell("kill -9 $$").exitStatus, 137);
}

TEST(Process, OutputBeyondAPipesSizeIsReadWithinBounds) {
    const ProcessResult result =
        shell("head -c 3000000 /dev/zero >&2; echo last >&2; head -c 3000000 /dev/zero");
    EXPECT_EQ(result.output.size(), size_t{1} << 20);
    EXPECT_EQ(result.errors.size(), size_t{64} << 10);
    EXPECT_TRUE(result.errors.ends_with("last\n"));
}

TEST(Process, AProcessRunsInTheGivenFolderWithItsArgumentsAsTheyAre) {
    const TempFolder folder;
    const std::string place = std::filesystem::canonical(folder.path()).string();
    EXPECT_EQ(shell("pwd -P", folder.path()).output, place + "\n");
    const auto run = test::valueOf(runProcess("/bin/echo", {"a b", "$HOME", "'\"*"}, "."));
    EXPECT_EQ(run.output, "a b $HOME '\"*\n");
    test::expectRefused(runProcess("no/such/program", {}, "."), "no/such/program");
    EXPECT_FALSE(findProgram("no such program").has_value());
    EXPECT_TRUE(findProgram("sh").has_value());
}

TEST(Video, AProgramOtherThanFfmpegIsRefused) {
    for (const char* program : {"/bin/true", "/bin/false", "no/such/ffmpeg"})
        test::expectRefused(findVideoEncoder(program), program);
}

TEST(Video, TheCodecIsTheBestThatFfmpegHas) {
    const TempFolder folder;
    const auto pretend = [&](const std::string& encoders, const VideoFormat& format = {}) {
        const auto program = folder.path() / "ffmpeg";
        std::ofstream(program) << "#!/bin/sh\nif [ \"$1\" = -version ]; then echo ffmpeg version 9"
                                  "; echo more; else echo '"
                               << encoders << "'; fi\n";
        std::filesystem::permissions(program, std::filesystem::perms::owner_all);
        return findVideoEncoder(program, format);
    };
    const auto best = test::valueOf(pretend(" V mpeg4 x\n V libx264 y"));
    EXPECT_EQ(best.codec, "libx264");
    EXPECT_EQ(best.version, "ffmpeg version 9");
    EXPECT_EQ(test::valueOf(pretend(" V libx264rgb y\n V mpeg4 x")).codec, "mpeg4");
    EXPECT_FALSE(pretend(" V gif x").ok());
    // A codec requested by name has no substitute.
    const VideoFormat h264{VideoCodec::H264, 10, ""};
    EXPECT_EQ(test::valueOf(pretend(" V mpeg4 x\n V libx264 y", h264)).codec, "libx264");
    EXPECT_FALSE(pretend(" V mpeg4 x", h264).ok());
    test::expectRefused(pretend(" V libx264 y", {VideoCodec::Av1, 8, ""}), "libaom-av1");
    EXPECT_FALSE(pretend(" V libx264 y", {VideoCodec::ProRes, 10, ""}).ok());
}

} // namespace
} // namespace shutter::io
