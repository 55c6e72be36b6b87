// SPDX-License-Identifier: MIT
// `shutter bench` by many processes: the results are those of one, stopped or not, and say so.
#include "tests/cli/child_processes.h"
#include "tests/cli/cli_fixture.h"
#include "tests/cli/fake_slurm.h"
#include "tests/cli/folder_watch.h"

#include <nlohmann/json.hpp>

#include <csignal>

namespace shutter::cli {

namespace {

using nlohmann::json;

class BenchInParts : public Cli {
  protected:
    [[nodiscard]] static Arguments
    measure(const std::string& out, const Arguments& suite, const Arguments& more) {
        Arguments all = {"bench", "--out", out};
        for (const Arguments* some : {&suite, &more, &kOnSoftware})
            all.insert(all.end(), some->begin(), some->end());
        return all;
    }

    [[nodiscard]] json readResults(const std::string& out) const {
        return json::parse(readFile(out + "/results.json"));
    }
};

const Arguments kTwoShots = {
    "--suite",
    "hard",
    "--case",
    "spin",
    "--case",
    "camera_pan",
    "--methods",
    "sharp,gather,resolved",
    "--size",
    "64x36",
    "--repeats",
    "2",
    "--truth-samples",
    "8"};
const Arguments kTwoHardCases = {
    "--suite", "stability", "--case", "ZeroMotion", "--case", "Paused"};

/// All of a run's cases but what was timed: that no two runs have in common.
json listFindings(const json& results) {
    json findings = json::array();
    for (const json& one : results.at("cases"))
        for (const json& row : one.at("measurements"))
            findings.push_back(
                {one.at("name"), row.at("method"), row.at("samples"), row.at("metrics")}
            );
    return findings;
}

} // namespace

TEST_F(BenchInParts, HasTheFindingsOfOneProcessAndSaysThatTimesAreShared) {
    requireDevice();
    if (IsSkipped())
        return;
    expectSuccess(measure("one", kTwoShots, {}));
    expectSuccess(measure("many", kTwoShots, {"--jobs", "2"}));
    const json one = readResults("one");
    const json many = readResults("many");
    EXPECT_EQ(listFindings(many), listFindings(one));
    EXPECT_EQ(many.at("equalTime").size(), 2u);
    EXPECT_TRUE(many.at("complete"));
    EXPECT_FALSE(one.contains("parallel"));
    EXPECT_EQ(many.at("parallel").at("processes"), 2);
    EXPECT_EQ(many.at("parallel").at("slurm"), false);
    EXPECT_EQ(many.at("parallel").at("machines"), json::array({many.at("machine").at("cpu")}));
    EXPECT_NE(readFile("many/index.html").find("</html>"), std::string::npos);
    EXPECT_FALSE(fs::exists(path("many/parts")));
}

TEST_F(BenchInParts, HardCasesAreMergedInTheSuitesOrder) {
    requireDevice();
    if (IsSkipped())
        return;
    expectSuccess(measure("many", kTwoHardCases, {"--jobs", "2"}));
    const json found = readResults("many").at("stability");
    ASSERT_EQ(found.size(), 2u);
    EXPECT_TRUE(found.at(0).at("held"));
    EXPECT_TRUE(found.at(1).at("held"));
    expectSuccess(measure("one", kTwoHardCases, {}));
    const json alone = readResults("one").at("stability");
    EXPECT_EQ(found.at(0).at("name"), alone.at(0).at("name"));
    EXPECT_EQ(found.at(1).at("name"), alone.at(1).at("name"));
}

TEST_F(BenchInParts, APartThatIsKilledGoesOnWhereItStopped) {
    requireDevice();
    if (IsSkipped())
        return;
    const Arguments bench = measure("many", kTwoShots, {"--jobs", "2"});
    fs::create_directories(path("many/journal"));
    const FolderWatch watch(path("many/journal"));
    const pid_t process = start(bench);
    watch.waitFor(12, process); // every write is two events
    for (const pid_t child : listChildren(process))
        kill(child, SIGKILL);
    const Outcome killed = finish(process);
    EXPECT_EQ(killed.status, 1);
    EXPECT_NE(killed.err.find("ended with status 137"), std::string::npos) << killed.err;
    json kept = json::object();
    for (const char* shot : {"spin", "camera_pan"})
        if (const std::string file = std::string("many/journal/") + shot + ".json";
            fs::exists(path(file)))
            kept[shot] = json::parse(readFile(file)).at("records");
    ASSERT_FALSE(kept.empty());

    // What measures may not change on the way, nor what is measured.
    const std::string device = readFile("many/parts/device.json");
    writeFile("many/parts/device.json", R"({"device": "another card", "driver": "7"})");
    const Outcome other = run(bench);
    EXPECT_EQ(other.status, 1);
    EXPECT_NE(other.err.find("the benchmark is drawn by 'another card'"), std::string::npos)
        << other.err;
    writeFile("many/parts/device.json", device);
    expectRefusal(
        measure("many", kTwoShots, {"--jobs", "2", "--limit", "9"}),
        1,
        {"--out", "planned otherwise", "--restart"}
    );
    expectRefusal({"bench-part", "many/parts", "2"}, 1, {"part 2 is none of the benchmark's"});
    expectRefusal({"bench-finish", "many/parts"}, 1, {"part", "is not measured", "no such file"});

    expectSuccess(bench);
    for (const auto& [shot, records] : kept.items()) {
        const json after = json::parse(readFile("many/journal/" + shot + ".json")).at("records");
        for (const auto& [key, record] : records.items())
            for (size_t i = 0; i < record.at("samples").size(); ++i)
                EXPECT_EQ(after.at(key).at("samples").at(i), record.at("samples").at(i)) << key;
    }
    EXPECT_EQ(readResults("many").at("cases").size(), 2u);
    EXPECT_FALSE(fs::exists(path("many/parts")));
}

TEST_F(BenchInParts, SlurmIsToldOfEveryCaseAndOfTheMerging) {
    const FakeSlurm slurm{path("")};
    slurm.writeProgram("sbatch", "case \"$*\" in *--array*) echo 7;; *) echo 8;; esac\n");
    const Arguments bench = measure("many", kTwoShots, {"--slurm", "--sbatch-part", "gres=gpu:1"});
    EXPECT_EQ(expectSuccess(bench).out, "job 7: parts 0-1\njob 8: finishes the benchmark\n");
    const std::string said = readFile("said");
    const size_t second = said.find("sbatch\n", 1);
    ASSERT_NE(second, std::string::npos) << said;
    EXPECT_LT(said.find("\n--array=0-1\n"), second);
    EXPECT_LT(said.find("\n--gres=gpu:1\n"), second);
    EXPECT_NE(said.find("/many/parts' \"$SLURM_ARRAY_TASK_ID\"\n"), std::string::npos) << said;
    EXPECT_NE(said.find("bench-finish '", second), std::string::npos) << said;
}

TEST_F(BenchInParts, ContradictionsAreRefusedBeforeAnythingIsWritten) {
    const auto refuse = [&](const Arguments& more, const Arguments& mentions) {
        expectRefusal(measure("many", kTwoShots, more), 2, mentions);
        EXPECT_FALSE(fs::exists(path("many")));
    };
    refuse({"--wait"}, {"--wait needs --slurm"});
    refuse({"--slurm", "--jobs", "2"}, {"--jobs and --slurm"});
    refuse({"--jobs", "0"}, {"--jobs"});
    expectRefusal({"bench-part", "nowhere", "0"}, 1, {"nowhere/plan.json"});
}

} // namespace shutter::cli
