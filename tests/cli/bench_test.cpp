// SPDX-License-Identifier: MIT
#include "tests/cli/cli_fixture.h"
#include "tests/cli/folder_watch.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <csignal>
#include <sstream>
#include <sys/wait.h>

namespace shutter::cli {

namespace {

using nlohmann::json;

class BenchCommand : public Cli {
  protected:
    /// A run that takes seconds: three methods, two timed pictures each.
    [[nodiscard]] Arguments benchPaper(const Arguments& more) const {
        Arguments all = {
            "bench",
            "--suite",
            "paper",
            "--out",
            path("report"),
            "--size",
            "64x36",
            "--methods",
            "sharp,gather,hybrid",
            "--repeats",
            "2",
            "--truth-samples",
            "8"};
        all.insert(all.end(), kOnSoftware.begin(), kOnSoftware.end());
        all.insert(all.end(), more.begin(), more.end());
        return all;
    }

    /// Two methods in a flight and in a played demo, so small that it takes seconds.
    [[nodiscard]] Arguments benchSequence(const Arguments& more) const {
        Arguments all = {
            "bench",
            "--suite",
            "sequence",
            "--out",
            path("report"),
            "--size",
            "64x36",
            "--methods",
            "sharp,resolved",
            "--truth-samples",
            "4"};
        all.insert(all.end(), kOnSoftware.begin(), kOnSoftware.end());
        all.insert(all.end(), more.begin(), more.end());
        return all;
    }

    /// Measures without a warning. \return the lines of progress
    std::vector<std::string> expectMeasured(const Arguments& arguments) const {
        const Outcome outcome = run(arguments);
        EXPECT_EQ(outcome.status, 0) << outcome.err;
        std::vector<std::string> lines;
        std::istringstream stream(outcome.err);
        for (std::string line; std::getline(stream, line); lines.push_back(line)) {
            EXPECT_TRUE(line.starts_with("shutter: measuring ")) << line;
            EXPECT_TRUE(line.ends_with(" % done")) << line;
        }
        return lines;
    }

    [[nodiscard]] json readResults() const { return json::parse(readFile("report/results.json")); }
};

} // namespace

TEST_F(BenchCommand, ASuiteOrASceneIsRequiredAndNotBoth) {
    expectRefusal({"bench", "--out", path("x")}, 2, {"--suite", "SCENE"});
    expectRefusal(
        {"bench", "a.glb", "--suite", "paper", "--out", path("x")}, 2, {"--suite", "SCENE"}
    );
}

TEST_F(BenchCommand, ASentenceExplainsHowToBuildItsProgramWhereThereIsNone) {
    isolateProgram();
    expectRefusal(
        {"bench", "--suite", "paper", "--out", path("x")},
        1,
        {"bench is a program of its own and was not built", "--target shutter_bench"}
    );
    EXPECT_NE(expectSuccess({"--help"}).out.find("bench"), std::string::npos);
}

TEST_F(BenchCommand, WrongNamesAreAnsweredWithTheKnownOnes) {
    const std::string out = path("x");
    expectRefusal({"bench", "--suite", "no", "--out", out}, 2, {"--suite", "no", "paper", "hard"});
    expectRefusal(
        {"bench", "--suite", "paper", "--methods", "no", "--out", out}, 2, {"--methods", "hybrid"}
    );
    expectRefusal(
        {"bench", "--suite", "paper", "--case", "no", "--out", out}, 2, {"--case", "vase"}
    );
}

TEST_F(BenchCommand, AntiAliasingIsAListOfKnownWords) {
    const std::string out = path("x");
    expectRefusal({"bench", "--suite", "paper", "--aa", "no", "--out", out}, 2, {"--aa", "taa"});
    expectRefusal(
        {"bench", "--suite", "paper", "--aa", "taa,taa", "--out", out}, 2, {"--aa", "twice"}
    );
    expectRefusal(
        {"bench", "--suite", "scaling", "--aa", "taa", "--out", out}, 2, {"--aa", "times alone"}
    );
    expectRefusal(
        {"bench", "--suite", "scaling", "--pixel", "box", "--out", out}, 2, {"--pixel", "alone"}
    );
}

TEST_F(BenchCommand, AFilmHasEvenSides) {
    expectRefusal(
        {"bench", "--suite", "sequence", "--size", "64x35", "--out", path("x")},
        2,
        {"--size 64x35", "even"}
    );
    expectRefusal(
        {"bench", "--suite", "sequence", "--case", "no", "--out", path("x")},
        2,
        {"--case", "vase-flight", "rally-play"}
    );
    expectRefusal(
        {"bench", "--suite", "sequence", "--frames", "1", "--out", path("x")}, 2, {"--frames"}
    );
}

TEST_F(BenchCommand, ASuiteHasShotsOfItsOwn) {
    expectRefusal(
        {"bench", "--suite", "paper", "--time", "1", "--out", path("x")}, 2, {"--time", "SCENE"}
    );
}

TEST_F(BenchCommand, EveryMethodAndSampleCountIsMeasuredAndThePageIsMade) {
    requireDevice();
    if (IsSkipped())
        return;
    const std::vector<std::string> progress = expectMeasured(benchPaper({"--validate"}));
    // One line per method, whatever its sample counts.
    ASSERT_EQ(progress.size(), 5u);
    EXPECT_EQ(progress[0], "shutter: measuring vase: the truth; 0 % done");
    EXPECT_TRUE(progress[1].starts_with("shutter: measuring vase: sharp, method 1 of 3; "));
    EXPECT_TRUE(progress[3].starts_with("shutter: measuring vase: hybrid, method 3 of 3; "));
    EXPECT_TRUE(progress[4].starts_with("shutter: measuring vase: times; "));
    const json results = readResults();
    EXPECT_EQ(results.at("schema"), "shutter-bench");
    EXPECT_TRUE(results.at("complete"));
    const json& vase = results.at("cases").at(0);
    // sharp once, gather and hybrid at 4, 8, 15, 16, 32 and 64 taps.
    ASSERT_EQ(vase.at("measurements").size(), 13u);
    for (const json& row : vase.at("measurements")) {
        EXPECT_EQ(row.at("repeats"), 2);
        EXPECT_GT(row.at("milliseconds").at("frame").at("median"), 0.0);
        // The page holds the pictures of defaults alone.
        ASSERT_EQ(row.contains("image"), row.at("isDefault").get<bool>());
        for (const char* field : {"image", "errorMap"})
            if (row.contains(field)) {
                EXPECT_TRUE(fs::exists(path("report/" + row.at(field).get<std::string>())));
            }
        EXPECT_GT(row.at("metrics").at("psnr"), 15.0);
    }
    EXPECT_EQ(results.at("equalTime").size(), 1u);
    const std::string page = readFile("report/index.html");
    EXPECT_NE(page.find("</html>"), std::string::npos);
}

TEST_F(BenchCommand, FlightsAndDemosAreJudgedOverTime) {
    requireDevice();
    if (IsSkipped())
        return;
    const auto progress = expectMeasured(benchSequence(
        {"--case", "courtyard-flight", "--case", "spin-play", "--frames", "4", "--validate"}
    ));
    ASSERT_GT(progress.size(), 8u);
    EXPECT_EQ(progress[0], "shutter: measuring courtyard-flight: frame 1 of 4; 0 % done");
    const json results = readResults();
    EXPECT_TRUE(results.at("complete"));
    EXPECT_EQ(results.at("options").at(2), "--case courtyard-flight");
    ASSERT_EQ(results.at("sequences").size(), 2u);
    EXPECT_EQ(results.at("settings").at("truthSamples"), 4);
    for (const json& film : results.at("sequences")) {
        EXPECT_EQ(film.at("frames"), 4);
        ASSERT_EQ(film.at("measurements").size(), 2u);
        for (const json& row : film.at("measurements")) {
            EXPECT_GT(row.at("milliseconds").at("frame").at("median"), 0.0);
            EXPECT_GT(row.at("metrics").at("psnr"), 15.0);
            EXPECT_GT(row.at("metrics").at("flicker"), 0.0);
            EXPECT_TRUE(row.at("metrics").at("standingFlicker").is_number());
            EXPECT_GT(row.at("metrics").at("hdrFlip"), 0.0);
            const json& flicker = row.at("curves").at("flicker");
            ASSERT_EQ(flicker.size(), 4u);
            EXPECT_TRUE(flicker.at(0).is_null()) << "there is no frame before the first";
            EXPECT_GT(flicker.at(3), 0.0);
            if (row.contains("film")) {
                EXPECT_TRUE(fs::exists(path("report/" + row.at("film").get<std::string>())));
            }
        }
        ASSERT_EQ(film.at("equalError").size(), 2u);
        EXPECT_EQ(film.at("equalError").at(0).at("rows").size(), 2u);
    }
    EXPECT_FALSE(fs::exists(path("report/frames/courtyard-flight"))) << "frames go with their film";
    EXPECT_NE(readFile("report/index.html").find("</html>"), std::string::npos);
}

TEST_F(BenchCommand, AStoppedSequenceResumes) {
    requireDevice();
    if (IsSkipped())
        return;
    const Arguments arguments = benchSequence({"--case", "spin-play", "--frames", "12"});
    fs::create_directories(path("report/journal"));
    const FolderWatch watch(path("report/journal"));
    const pid_t process = start(arguments);
    watch.waitFor(11, process); // every write is two events; frames are written one by one
    kill(process, SIGINT);
    int status = 0;
    waitpid(process, &status, 0);
    ASSERT_TRUE(WIFEXITED(status));
    EXPECT_EQ(WEXITSTATUS(status), 1);
    const auto readRecords = [&] {
        return json::parse(readFile("report/journal/spin-play.json")).at("records");
    };
    const json before = readRecords();
    ASSERT_TRUE(before.contains("own/resolved/15/4"));
    ASSERT_FALSE(before.contains("own/resolved/15/11"));
    expectMeasured(arguments);
    const json after = readRecords();
    for (const auto& [key, record] : before.items())
        EXPECT_EQ(after.at(key), record) << key;
    // The first frame of the second run flickers against the last of the first one.
    for (int frame = 1; frame < 12; ++frame) {
        const std::string key = fmt::format("own/sharp/0/{}", frame);
        EXPECT_TRUE(after.at(key).at("picture").at("metrics").contains("flicker")) << key;
    }
    const json once = readResults().at("sequences");
    expectMeasured(arguments);
    EXPECT_EQ(readResults().at("sequences"), once) << "a third run measures nothing";
    const json& row = once.at(0).at("measurements").at(0);
    if (!row.contains("film"))
        return; // no encoder
    const std::string film = "report/" + row.at("film").get<std::string>();
    const std::string twelve = readFile(film);
    expectMeasured(benchSequence({"--case", "spin-play", "--frames", "3"}));
    EXPECT_NE(readFile(film), twelve) << "the film of other frames is left";
}

TEST_F(BenchCommand, AStoppedRunResumes) {
    requireDevice();
    if (IsSkipped())
        return;
    fs::create_directories(path("report/journal"));
    const FolderWatch watch(path("report/journal"));
    const pid_t process = start(benchPaper({}));
    watch.waitFor(21, process); // every write is two events; some 40 are to come
    kill(process, SIGINT);
    int status = 0;
    waitpid(process, &status, 0);
    ASSERT_TRUE(WIFEXITED(status));
    EXPECT_EQ(WEXITSTATUS(status), 1);
    const json before = json::parse(readFile("report/journal/vase.json"));
    const json kept = before.at("records").at("sharp/0");
    ASSERT_FALSE(kept.at("picture").empty());
    expectMeasured(benchPaper({}));
    const json after = json::parse(readFile("report/journal/vase.json"));
    EXPECT_EQ(after.at("records").at("sharp/0").at("picture"), kept.at("picture"));
    EXPECT_TRUE(readResults().at("complete"));
    // A third run measures nothing: its results have the same times.
    const json twice = readResults().at("cases");
    expectMeasured(benchPaper({}));
    EXPECT_EQ(readResults().at("cases"), twice);
}

TEST_F(BenchCommand, ASceneOfOnesOwnIsMeasuredAsTyped) {
    requireDevice();
    if (IsSkipped())
        return;
    const std::string scene = std::string(SHUTTER_ASSETS) + "/courtyard.glb";
    Arguments arguments = benchPaper({"--time", "0.05", "--camera", "pan", "--phase", "centre"});
    arguments.erase(arguments.begin() + 1, arguments.begin() + 3);
    arguments.insert(arguments.begin() + 1, scene);
    expectMeasured(arguments);
    const json shot = readResults().at("cases").at(0);
    EXPECT_EQ(shot.at("title"), "courtyard.glb");
    EXPECT_EQ(shot.at("camera"), "pan");
    EXPECT_EQ(shot.at("phase"), "centre");
    EXPECT_EQ(shot.at("time"), 0.05);
}

} // namespace shutter::cli
