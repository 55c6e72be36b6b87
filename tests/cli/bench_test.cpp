// SPDX-License-Identifier: MIT
#include "game/bench/bench_arguments.h"
#include "tests/cli/cli_fixture.h"
#include "tests/cli/folder_watch.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <csignal>
#include <sstream>
#include <utility>

namespace shutter::cli {

namespace {

using nlohmann::json;

class BenchCommand : public Cli {
  protected:
    /// `bench` of `what` by methods, so small that it takes seconds.
    [[nodiscard]] Arguments
    measure(const Arguments& what, const std::string& methods, const Arguments& more) const {
        const Arguments small = {
            "--out",
            path("report"),
            "--size",
            "64x36",
            "--methods",
            methods,
            "--truth-samples",
            "4"};
        return join(join(join(join({"bench"}, what), small), kOnSoftware), more);
    }

    /// Measures without a warning; lines of progress alone are printed.
    void expectMeasured(const Arguments& arguments) const {
        const Outcome outcome = run(arguments);
        EXPECT_EQ(outcome.status, 0) << outcome.err;
        std::istringstream stream(outcome.err);
        for (std::string line; std::getline(stream, line);) {
            EXPECT_TRUE(line.starts_with("shutter: measuring ")) << line;
            EXPECT_TRUE(line.ends_with(" % done")) << line;
        }
    }

    /// Interrupts the run once so many files of its journal were created or renamed.
    void stopAfter(int events, const Arguments& arguments) const {
        fs::create_directories(path("report/journal"));
        const FolderWatch watch(path("report/journal"));
        const pid_t process = start(arguments);
        watch.waitFor(events, process);
        EXPECT_EQ(stop(process, SIGINT).status, kFailed);
    }

    [[nodiscard]] json readJson(const std::string& file) const {
        return json::parse(readFile("report/" + file));
    }
};

} // namespace

TEST_F(BenchCommand, WrongUsageIsRefusedByOption) {
    const std::vector<std::pair<Arguments, Arguments>> refused = {
        {{}, {"--suite", "SCENE"}},
        {{"a.glb", "--suite", "paper"}, {"--suite", "SCENE"}},
        {{"--suite", "no"}, {"--suite", "no", "paper", "hard"}},
        {{"--suite", "paper", "--methods", "no"}, {"--methods", "hybrid"}},
        {{"--suite", "paper", "--case", "no"}, {"--case", "vase"}},
        {{"--suite", "paper", "--aa", "no"}, {"--aa", "taa"}},
        {{"--suite", "paper", "--aa", "taa,taa"}, {"--aa", "twice"}},
        {{"--suite", "paper", "--time", "1"}, {"--time", "SCENE"}},
        {{"--suite", "scaling", "--aa", "taa"}, {"--aa", "times alone"}},
        {{"--suite", "scaling", "--pixel", "box"}, {"--pixel", "alone"}},
        {{"--suite", "sequence", "--size", "64x35"}, {"--size 64x35", "even"}},
        {{"--suite", "sequence", "--case", "no"}, {"--case", "vase-flight", "rally-play"}},
        {{"--suite", "sequence", "--frames", "1"}, {"--frames"}}};
    for (const auto& [words, mentions] : refused) {
        CLI::App app;
        bench::BenchArguments arguments;
        bench::defineBenchOptions(app, arguments);
        Arguments reversed = join(words, {"--out", "x"});
        std::reverse(reversed.begin(), reversed.end()); // as CLI11 takes them
        std::string error;
        try {
            app.parse(reversed);
            const auto task = bench::interpretBench(arguments);
            error = task ? "" : task.error().message;
        } catch (const CLI::ParseError& parsed) {
            error = parsed.what();
        }
        for (const std::string& mention : mentions)
            EXPECT_NE(error.find(mention), std::string::npos) << mention << "\n" << error;
    }
}

TEST_F(BenchCommand, AStoppedSequenceResumes) {
    requireDevice();
    if (IsSkipped())
        return;
    const auto play = [&](const char* frames) {
        return measure(
            {"--suite", "sequence"}, "sharp,resolved", {"--case", "spin-play", "--frames", frames}
        );
    };
    stopAfter(11, play("12")); // every write is two events; frames are written one by one
    const auto readRecords = [&] { return readJson("journal/spin-play.json").at("records"); };
    const json before = readRecords();
    ASSERT_TRUE(before.contains("own/resolved/15/4"));
    ASSERT_FALSE(before.contains("own/resolved/15/11"));
    expectMeasured(play("12"));
    const json after = readRecords();
    for (const auto& [key, record] : before.items())
        EXPECT_EQ(after.at(key), record) << key;
    // The first frame of the second run flickers against the last of the first one.
    for (int frame = 1; frame < 12; ++frame) {
        const std::string key = fmt::format("own/sharp/0/{}", frame);
        EXPECT_TRUE(after.at(key).at("picture").at("metrics").contains("flicker")) << key;
    }
    const json once = readJson("results.json").at("sequences");
    expectMeasured(play("12"));
    EXPECT_EQ(readJson("results.json").at("sequences"), once) << "a third run measures nothing";
    const json& row = once.at(0).at("measurements").at(0);
    if (!row.contains("film"))
        return; // no encoder
    const std::string film = "report/" + row.at("film").get<std::string>();
    const std::string twelve = readFile(film);
    expectMeasured(play("3"));
    EXPECT_NE(readFile(film), twelve) << "the film of other frames is left";
}

TEST_F(BenchCommand, AStoppedRunResumesAndASceneOfOnesOwnIsMeasuredAsTyped) {
    requireDevice();
    if (IsSkipped())
        return;
    const Arguments arguments = measure(
        {SHUTTER_ASSETS "/courtyard.glb"},
        "sharp,gather",
        {"--repeats", "2", "--time", "0.05", "--camera", "pan", "--phase", "centre"}
    );
    stopAfter(7, arguments); // every write is two events; some 40 are to come
    const auto readSharp = [&] {
        return readJson("journal/own.json").at("records").at("sharp/0").at("picture");
    };
    const json kept = readSharp();
    ASSERT_FALSE(kept.empty());
    expectMeasured(arguments);
    EXPECT_EQ(readSharp(), kept);
    const json results = readJson("results.json");
    EXPECT_TRUE(results.at("complete"));
    // A third run measures nothing: its results have the same times.
    expectMeasured(arguments);
    EXPECT_EQ(readJson("results.json").at("cases"), results.at("cases"));
    const json shot = results.at("cases").at(0);
    EXPECT_EQ(shot.at("title"), "courtyard.glb");
    EXPECT_EQ(shot.at("camera"), "pan");
    EXPECT_EQ(shot.at("phase"), "centre");
    EXPECT_EQ(shot.at("time"), 0.05);
}

} // namespace shutter::cli
