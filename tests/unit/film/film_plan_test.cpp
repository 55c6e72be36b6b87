// SPDX-License-Identifier: MIT
#include "game/film/film_plan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <numeric>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace shutter::film {
namespace {

namespace fs = std::filesystem;

double sumOf(const std::vector<double>& costs, const FilmPart& part) {
    return std::accumulate(
        costs.begin() + part.first, costs.begin() + part.first + part.count, 0.0
    );
}

class PlanFile : public testing::Test {
  protected:
    PlanFile() {
        const auto* test = testing::UnitTest::GetInstance()->current_test_info();
        mFile = fs::path(testing::TempDir()) / (std::string("plan_") + test->name() + ".json");
    }

    ~PlanFile() override { fs::remove(mFile); }

    void expectRefused(const std::string& text, const std::string& mention) const {
        std::ofstream(mFile) << text;
        const auto plan = readPlan(mFile);
        ASSERT_FALSE(plan.ok()) << text;
        EXPECT_NE(plan.error().message.find(mention), std::string::npos) << plan.error().message;
    }

    fs::path mFile;
};

} // namespace

TEST(FilmParts, CoverEachFrameOnceAndShareTheCost) {
    std::mt19937 random(7);
    for (int round = 0; round < 200; ++round) {
        std::vector<double> costs(1 + random() % 60);
        for (double& cost : costs)
            cost = double(random() % 100);
        const auto wanted = uint32_t(1 + random() % 12);
        const auto parts = splitIntoParts(costs, wanted);
        ASSERT_EQ(parts.size(), std::min<size_t>(wanted, costs.size()));
        uint32_t next = 0;
        for (const FilmPart& part : parts) {
            EXPECT_EQ(part.first, next);
            EXPECT_GT(part.count, 0u);
            next += part.count;
        }
        EXPECT_EQ(next, costs.size());
        // Each end misses its share by half a frame at most, where no part is down to one frame.
        const double total = std::accumulate(costs.begin(), costs.end(), 0.0);
        const double dearest = *std::max_element(costs.begin(), costs.end());
        const bool isRoomy = std::all_of(parts.begin(), parts.end(), [](const FilmPart& part) {
            return part.count > 1;
        });
        if (isRoomy) {
            for (const FilmPart& part : parts)
                EXPECT_LE(sumOf(costs, part), total / double(parts.size()) + dearest + 1.0e-9);
        }
    }
}

TEST(FilmParts, OfEqualFramesAreEquallyLong) {
    const std::vector<FilmPart> expected = {{0, 60}, {60, 60}, {120, 60}, {180, 60}};
    EXPECT_EQ(splitIntoParts(std::vector<double>(240, 3.5), 4), expected);
    EXPECT_EQ(splitIntoParts(std::vector<double>(240, 0.0), 4), expected);
}

TEST(FilmParts, AreShorterWhereFramesAreDear) {
    std::vector<double> costs(100, 1.0);
    std::fill(costs.begin() + 50, costs.end(), 9.0);
    const auto parts = splitIntoParts(costs, 2);
    EXPECT_EQ(parts[0].count, 72u); // 50 + 22 * 9 = 248 of 500
    EXPECT_EQ(parts[1].count, 28u);
}

TEST(FilmCosts, LieBetweenThoseThatWereMeasured) {
    const std::vector<std::pair<uint32_t, double>> samples = {{1, 10.0}, {3, 20.0}, {5, 0.0}};
    const std::vector<double> expected = {10.0, 10.0, 15.0, 20.0, 10.0, 0.0, 0.0};
    EXPECT_EQ(interpolateCosts(samples, 7), expected);
}

TEST_F(PlanFile, ReadsWhatWasWritten) {
    FilmPlan plan;
    plan.fingerprint = "0123";
    plan.folder = "/films and more";
    plan.words = {"scene.glb", "--out", "film.mp4", "--frames", "-2:7"};
    plan.parts = {{0, 4}, {4, 6}};
    ASSERT_TRUE(writePlan(mFile, plan).ok());
    const auto read = readPlan(mFile);
    ASSERT_TRUE(read.ok()) << read.error().message;
    EXPECT_EQ(read.value().fingerprint, plan.fingerprint);
    EXPECT_EQ(read.value().folder, plan.folder);
    EXPECT_EQ(read.value().words, plan.words);
    EXPECT_EQ(read.value().parts, plan.parts);
    EXPECT_EQ(read.value().frameCount(), 10u);
}

TEST_F(PlanFile, RefusesPartsThatLeaveFramesOut) {
    const auto plan = [](const std::string& parts) {
        return R"({"version": 1, "fingerprint": "f", "folder": "/", "options": ["s.glb"], "parts": )" +
               parts + "}";
    };
    expectRefused(
        plan(R"([{"first": 0, "count": 2}, {"first": 3, "count": 1}])"), "parts[1].first"
    );
    expectRefused(
        plan(R"([{"first": 0, "count": 2}, {"first": 1, "count": 1}])"), "parts[1].first"
    );
    expectRefused(plan(R"([{"first": 0, "count": 0}])"), "parts[0].count");
    expectRefused(plan("[]"), "parts");
    expectRefused(R"({"version": 2})", "version");
}

} // namespace shutter::film
