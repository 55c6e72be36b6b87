// SPDX-License-Identifier: MIT
#include "game/bench/bench_parts.h"
#include "tests/support/temp_folder.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace shutter::bench {

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

Suite makeSuite() {
    Suite suite;
    for (const char* name : {"a", "b"}) {
        Case shot;
        shot.name = name;
        suite.cases.push_back(shot);
    }
    ScalingAxis axis;
    axis.name = "c";
    suite.axes.push_back(axis);
    SequenceCase sequence;
    sequence.name = "s";
    suite.sequences.push_back(sequence);
    stability::HardCase hard;
    hard.name = "d";
    suite.hardCases.push_back(hard);
    demand::Claim claim;
    claim.name = "e";
    suite.claims.push_back(claim);
    return suite;
}

/// Results as a part leaves them.
json makeResults(const std::string& created, const std::string& cpu) {
    return {
        {"suite", "hard"},
        {"created", created},
        {"complete", true},
        {"machine", {{"cpu", cpu}}},
        {"cases", json::array()}};
}

class BenchParts : public testing::Test {
  protected:
    BenchPlan makePlan(uint32_t jobs) const {
        parts::JobOptions options;
        options.jobs = jobs;
        auto plan = makeBenchPlan({"--suite", "hard"}, {"case a", "case b"}, options);
        EXPECT_TRUE(plan) << plan.error().message;
        return plan.value();
    }

    void writePart(uint32_t part, const json& results) const {
        mFolder.write(partResults("", part).string(), results.dump());
    }

    test::TempFolder mFolder;
};

} // namespace

TEST_F(BenchParts, AreEveryCaseOfTheSuiteOnce) {
    const Suite suite = makeSuite();
    const std::vector<std::string> names = listBenchParts(suite);
    EXPECT_EQ(
        names,
        (std::vector<std::string>{
            "case a", "case b", "axis c", "sequence s", "hard case d", "claim e"})
    );
    for (uint32_t part = 0; part < names.size(); ++part)
        EXPECT_EQ(
            listBenchParts(keepBenchPart(suite, part)), std::vector<std::string>{names[part]}
        );
}

TEST_F(BenchParts, AreTheResultsOfOneRunTogether) {
    const BenchPlan plan = makePlan(2);
    json first = makeResults("2026-01-01T00:00:02Z", "cpu");
    first["cases"] = {{{"name", "a"}}};
    first["equalTime"] = {{{"case", "a"}}};
    json second = makeResults("2026-01-01T00:00:01Z", "another cpu");
    second["cases"] = {{{"name", "b"}}};
    writePart(0, first);
    const auto lacking = mergeBenchParts(plan, mFolder.path());
    ASSERT_FALSE(lacking);
    EXPECT_NE(lacking.error().message.find("part 1, case b, is not measured"), std::string::npos)
        << lacking.error().message;
    writePart(1, second);
    const auto merged = mergeBenchParts(plan, mFolder.path());
    ASSERT_TRUE(merged) << merged.error().message;
    EXPECT_EQ(merged.value().at("cases"), json({{{"name", "a"}}, {{"name", "b"}}}));
    EXPECT_EQ(merged.value().at("equalTime").size(), 1u);
    EXPECT_EQ(merged.value().at("created"), "2026-01-01T00:00:02Z");
    EXPECT_EQ(
        merged.value().at("parallel"),
        json({{"processes", 2}, {"slurm", false}, {"machines", {"another cpu", "cpu"}}})
    );
    // One process at a time had the machine alone.
    EXPECT_FALSE(mergeBenchParts(makePlan(1), mFolder.path()).value().contains("parallel"));
    for (const char* damaged : {"", "[]", "{\"created\": 1}", "{\"suite\":"}) {
        mFolder.write("part_1.json", damaged);
        EXPECT_FALSE(mergeBenchParts(plan, mFolder.path())) << damaged;
    }
}

TEST_F(BenchParts, APlanGoesOnUnlessItIsAnother) {
    const fs::path folder = mFolder.path() / "parts";
    BenchPlan plan = makePlan(4);
    ASSERT_TRUE(keepBenchPlan(plan, folder, false));
    const auto opened = openBenchPlan(folder);
    ASSERT_TRUE(opened) << opened.error().message;
    EXPECT_EQ(opened.value().words, plan.words);
    EXPECT_EQ(opened.value().parts, plan.parts);
    // Fewer processes go on with it; that there were more once is remembered.
    BenchPlan fewer = makePlan(2);
    ASSERT_TRUE(keepBenchPlan(fewer, folder, false));
    EXPECT_EQ(fewer.processes, 4u);
    BenchPlan other = makeBenchPlan({"--suite", "paper"}, {"case a"}, {}).value();
    const core::Status refused = keepBenchPlan(other, folder, false);
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.error().message.find("--restart"), std::string::npos);
    ASSERT_TRUE(keepBenchPlan(other, folder, true));
    EXPECT_EQ(openBenchPlan(folder).value().parts, other.parts);
}

TEST_F(BenchParts, APartIsDoneOnceItsResultsAreThere) {
    const BenchPlan plan = makePlan(2);
    const parts::PartWork work = describeBenchWork(plan, mFolder.path());
    EXPECT_EQ(work.stepCount, 2u);
    EXPECT_EQ(work.listUnfinished().value(), (std::vector<uint32_t>{0, 1}));
    writePart(0, makeResults("", ""));
    EXPECT_EQ(work.listUnfinished().value(), std::vector<uint32_t>{1});
    EXPECT_EQ(work.countDone(), 1u);
}

} // namespace shutter::bench
