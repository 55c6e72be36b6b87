// SPDX-License-Identifier: MIT
#include "engine/io/file_bytes.h"
#include "game/parts/job_options.h"
#include "game/parts/part_commands.h"
#include "game/parts/part_slurm.h"
#include "game/parts/part_work.h"
#include "tests/support/temp_folder.h"

#include <CLI/CLI.hpp>
#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

namespace shutter::parts {
namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

/// What is said of a command line's jobs; empty where they are fine.
std::string refuse(const Words& words) {
    CLI::App app;
    JobOptions options;
    defineJobOptions(app, options);
    const core::Status parsed = parseWords(app, words);
    const core::Status checked = parsed ? checkJobs(options) : parsed;
    return checked ? std::string() : checked.error().message;
}

} // namespace

TEST(JobOptionsTest, WhatNeedsOrExcludesAnotherIsNamed) {
    EXPECT_EQ(refuse({}), "");
    EXPECT_EQ(refuse({"--jobs", "4", "--devices", "0,1"}), "");
    EXPECT_EQ(refuse({"--slurm", "--wait", "--sbatch", "partition=x"}), "");
    EXPECT_EQ(refuse({"--wait"}), "--wait needs --slurm");
    EXPECT_EQ(refuse({"--sbatch", "partition=x"}), "--sbatch needs --slurm");
    EXPECT_EQ(refuse({"--sbatch-part", "gres=gpu:1"}), "--sbatch-part needs --slurm");
    EXPECT_EQ(refuse({"--slurm", "--jobs", "2"}), "--jobs and --slurm exclude each other");
    EXPECT_EQ(refuse({"--slurm", "--devices", "0"}), "--devices and --slurm exclude each other");
    EXPECT_TRUE(refuse({"--jobs", "0"}).starts_with("--jobs: "));
}

TEST(TypedWords, MeanWhatWasTypedWithoutWhatIsLeftOut) {
    CLI::App app;
    std::string place;
    std::vector<std::string> many;
    bool flag = false;
    bool left = false;
    int never = 0;
    app.add_option("scene", place);
    app.add_option("--many", many);
    app.add_flag("--flag", flag);
    app.add_flag("--left", left);
    app.add_option("--never", never);
    std::vector<const CLI::Option*> options;
    for (const CLI::Option* option : app.get_options())
        options.push_back(option);
    const Words typed = {"--many", "a b", "--flag", "--many", "-c", "--left", "--", "s.glb"};
    ASSERT_TRUE(parseWords(app, typed).ok());
    constexpr std::array<std::string_view, 1> kLeft = {"--left"};
    EXPECT_EQ(
        listTypedWords(options, kLeft), (Words{"s.glb", "--many", "a b", "--many", "-c", "--flag"})
    );
}

TEST(PartFiles, OfAWorkAreRemovedAndOthersStay) {
    const test::TempFolder folder;
    for (const fs::path& file :
         {deviceFile(folder.path()),
          jobsFile(folder.path()),
          finishLog(folder.path()),
          partLog(folder.path(), 0),
          partLog(folder.path(), 1)})
        folder.write(file.filename().string(), "x");
    folder.write(io::makeTemporaryPath(folder.path() / "part_0.json").filename().string(), "half");
    folder.write("part_2.log", "of another work");
    removePartFiles(folder.path(), 2);
    std::vector<std::string> left;
    for (const auto& entry : fs::directory_iterator(folder.path()))
        left.push_back(entry.path().filename().string());
    EXPECT_EQ(left, std::vector<std::string>{"part_2.log"});
}

TEST(SlurmTasks, AreRangesAndSingles) {
    const auto format = [](const std::vector<uint32_t>& tasks) { return formatTasks(tasks); };
    EXPECT_EQ(format({0, 1, 2, 3}), "0-3");
    EXPECT_EQ(format({2}), "2");
    EXPECT_EQ(format({0, 2, 3, 7}), "0,2-3,7");
}

TEST(LastSentence, IsTheLastLineThatHoldsAnything) {
    EXPECT_EQ(findLastSentence("first\nshutter: no room\n\n"), "no room");
    EXPECT_EQ(findLastSentence("slurmstepd: error"), "slurmstepd: error");
    EXPECT_EQ(findLastSentence(" \n"), "");
}

} // namespace shutter::parts
