// SPDX-License-Identifier: MIT
#include "engine/io/process.h"
#include "engine/io/video.h"
#include "tests/support/temp_folder.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

namespace shutter::io {
namespace {

using test::TempFolder;

ProcessResult shell(const std::string& script, const std::filesystem::path& folder = ".") {
    auto run = runProcess("/bin/sh", {"-c", script}, folder);
    EXPECT_TRUE(run.ok());
    return std::move(run).value();
}

TEST(Process, GivesBackBothStreamsAndTheExitStatus) {
    const ProcessResult result = shell("echo out; echo err >&2; cat; exit 7");
    EXPECT_EQ(result.output, "out\n") << "nothing is on its stdin";
    EXPECT_EQ(result.errors, "err\n");
    EXPECT_EQ(result.exitStatus, 7);
    EXPECT_EQ(shell("kill -9 $$").exitStatus, 137);
}

TEST(Process, RunsWhereItIsTold) {
    const TempFolder folder;
    EXPECT_EQ(
        shell("pwd -P", folder.path()).output,
        std::filesystem::canonical(folder.path()).string() + "\n"
    );
}

TEST(Process, MoreThanAPipeHoldsIsReadAndKeptInBounds) {
    const ProcessResult result =
        shell("head -c 3000000 /dev/zero >&2; echo last >&2; head -c 3000000 /dev/zero");
    EXPECT_EQ(result.output.size(), size_t{1} << 20);
    EXPECT_EQ(result.errors.size(), size_t{64} << 10);
    EXPECT_TRUE(result.errors.ends_with("last\n"));
}

TEST(Process, ArgumentsReachTheProgramAsTheyAre) {
    const auto run = runProcess("/bin/echo", {"a b", "$HOME", "'\"*"}, ".");
    ASSERT_TRUE(run.ok());
    EXPECT_EQ(run.value().output, "a b $HOME '\"*\n");
}

TEST(Process, AProgramThatIsNotThereIsNamed) {
    const auto run = runProcess("no/such/program", {}, ".");
    ASSERT_FALSE(run.ok());
    EXPECT_NE(run.error().message.find("no/such/program"), std::string::npos);
    EXPECT_FALSE(findProgram("no such program").has_value());
    EXPECT_TRUE(findProgram("sh").has_value());
}

TEST(Video, WhatIsNoFfmpegIsRefused) {
    for (const char* program : {"/bin/true", "/bin/false", "no/such/ffmpeg"}) {
        const auto encoder = findVideoEncoder(program);
        ASSERT_FALSE(encoder.ok()) << program;
        EXPECT_NE(encoder.error().message.find(program), std::string::npos);
    }
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
    const auto best = pretend(" V mpeg4 x\n V libx264 y");
    ASSERT_TRUE(best.ok()) << best.error().message;
    EXPECT_EQ(best.value().codec, "libx264");
    EXPECT_EQ(best.value().version, "ffmpeg version 9");
    const auto second = pretend(" V libx264rgb y\n V mpeg4 x");
    ASSERT_TRUE(second.ok());
    EXPECT_EQ(second.value().codec, "mpeg4");
    EXPECT_FALSE(pretend(" V gif x").ok());
    // What was wanted by name has no substitute.
    const auto deep = pretend(" V mpeg4 x\n V libx264 y", {VideoCodec::H264, 10, ""});
    ASSERT_TRUE(deep.ok()) << deep.error().message;
    EXPECT_EQ(deep.value().codec, "libx264");
    EXPECT_FALSE(pretend(" V mpeg4 x", {VideoCodec::H264, 10, ""}).ok());
    const auto other = pretend(" V libx264 y", {VideoCodec::Av1, 8, ""});
    ASSERT_FALSE(other.ok());
    EXPECT_NE(other.error().message.find("libaom-av1"), std::string::npos);
    EXPECT_FALSE(pretend(" V libx264 y", {VideoCodec::ProRes, 10, ""}).ok());
}

} // namespace
} // namespace shutter::io
