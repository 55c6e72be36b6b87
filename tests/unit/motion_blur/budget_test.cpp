// SPDX-License-Identifier: MIT
#include "modules/motion_blur/budget.h"
#include "modules/motion_blur/methods.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <set>
#include <vector>

namespace shutter::motion_blur {

namespace {

MotionBlurSettings settingsOf(const Method* method, uint32_t samples = 15) {
    MotionBlurSettings settings;
    settings.method = method;
    settings.sampleCount = samples;
    return settings;
}

/// What a frame takes on a device: some for the tiles, some a sample, some for rays.
struct Load {
    double tiles = 1.0;
    double perSample = 1.0;
    double rays = 30.0;

    [[nodiscard]] double of(const BudgetLevel& level) const {
        const MotionBlurSettings& s = level.settings;
        const double resolution = std::isinf(s.halfResolutionPx) ? 1.0 : 0.8;
        // One read a sample where the others have two.
        const double read = s.method == &getMethod("own_velocity") ? 0.4 : 1.0;
        const double traced = s.method == &getMethod("hybrid") ? rays * s.rayShare : 0.0;
        return tiles + perSample * read * s.sampleCount * resolution + traced;
    }
};

/// Pseudo-random numbers in [-1, 1), the same everywhere.
double noise(uint32_t& state) {
    state = state * 1664525u + 1013904223u;
    return (state >> 8) / double(1u << 23) - 1.0;
}

struct Drive {
    std::vector<size_t> levels;
    std::vector<double> times;

    [[nodiscard]] size_t changes(size_t from) const {
        size_t count = 0;
        for (size_t i = from + 1; i < levels.size(); ++i)
            count += levels[i] != levels[i - 1];
        return count;
    }

    [[nodiscard]] double shareOver(double budget, size_t from) const {
        size_t over = 0;
        for (size_t i = from; i < times.size(); ++i)
            over += times[i] > budget;
        return double(over) / double(times.size() - from);
    }
};

Drive drive(
    BudgetController& controller,
    const Load& load,
    int frames,
    double spread = 0.0,
    uint32_t seed = 1
) {
    Drive result;
    for (int i = 0; i < frames; ++i) {
        const size_t level = controller.level();
        const double time = load.of(controller.current()) * (1.0 + spread * noise(seed));
        result.levels.push_back(level);
        result.times.push_back(time);
        controller.observe(level, time);
    }
    return result;
}

} // namespace

TEST(Budget, RungsStartWithTheRequestedSettingsAndEndWithTheCheapestBlur) {
    for (const Method* method : listMethods())
        for (const uint32_t samples : {1u, 4u, 15u, 256u}) {
            const auto levels = makeLevels(settingsOf(method, samples));
            EXPECT_TRUE(levels.front().droppedQuality.empty());
            EXPECT_EQ(levels.front().settings.sampleCount, samples);
            EXPECT_EQ(levels.front().settings.method, method);
            const MotionBlurSettings& last = levels.back().settings;
            EXPECT_EQ(last.method, &getMethod("own_velocity"));
            EXPECT_GE(last.sampleCount, std::min(samples, 4u)) << "fewer are ghosts";
            EXPECT_LE(last.sampleCount, 4u);
            std::set<std::string> named;
            for (size_t i = 1; i < levels.size(); ++i) {
                EXPECT_LT(levels[i].cost, levels[i - 1].cost) << method->name << " level " << i;
                EXPECT_TRUE(validate(levels[i].settings).ok()) << levels[i].droppedQuality;
                EXPECT_TRUE(named.insert(levels[i].droppedQuality).second)
                    << levels[i].droppedQuality;
                EXPECT_LE(levels[i].settings.rayShare, levels[i - 1].settings.rayShare);
            }
        }
}

TEST(Budget, LaddersNameWhatTheyGiveUp) {
    auto levels = makeLevels(settingsOf(&getMethod("hybrid")));
    EXPECT_EQ(levels[1].droppedQuality, "half of the resolution along long uniform motion");
    EXPECT_EQ(
        levels[3].droppedQuality,
        "half of the resolution along long uniform motion, 50 % of the rays"
    );
    EXPECT_EQ(
        levels[levels.size() - 2].droppedQuality,
        "half of the resolution along long uniform motion, all rays, 11 of 15 samples"
    );
    EXPECT_EQ(levels.back().droppedQuality, "all but 4 samples along each pixel's own motion");
    levels = makeLevels(settingsOf(&getMethod("denoised"), 4)); // counts taps once it has them
    EXPECT_EQ(levels[1].droppedQuality, "2 of 4 samples");
    EXPECT_EQ(levels[2].droppedQuality, "3 of 4 samples");
    EXPECT_EQ(levels[3].droppedQuality, "all rays");
    EXPECT_EQ(levels[3].settings.method, &getMethod("gather"));
    EXPECT_EQ(levels[4].droppedQuality, "all rays, 3 of 15 samples");
    // From few instants to each pixel's own motion; the second raster goes first.
    levels = makeLevels(settingsOf(&getMethod("resolved"), 15));
    ASSERT_EQ(levels.size(), 6u);
    for (size_t i = 0; i < 4; ++i)
        EXPECT_EQ(levels[i].settings.method, &getMethod("resolved")) << i;
    EXPECT_EQ(levels[3].settings.sampleCount, 6u);
    EXPECT_EQ(levels[3].droppedQuality, "9 of 15 samples");
    EXPECT_EQ(levels[4].settings.method, &getMethod("own_velocity"));
    EXPECT_EQ(levels[4].settings.sampleCount, 8u);
    EXPECT_EQ(levels[4].droppedQuality, "the blur beyond the outlines of movers");
    MotionBlurSettings settings = settingsOf(&getMethod("resolved"));
    settings.secondRaster = true;
    levels = makeLevels(settings);
    EXPECT_EQ(levels[1].droppedQuality, "the second raster");
    EXPECT_FALSE(levels[1].settings.secondRaster);
    EXPECT_EQ(levels[2].droppedQuality, "the second raster, 3 of 15 samples");
}

TEST(Budget, MethodsWithoutAUniformPathDoNotReduceResolution) {
    MotionBlurSettings settings = settingsOf(&getMethod("hybrid"));
    settings.uniformMotionPx = 0.0f;
    for (const BudgetLevel& level : makeLevels(settings))
        EXPECT_EQ(level.droppedQuality.find("resolution"), std::string::npos)
            << level.droppedQuality;
}

TEST(Budget, ABudgetRequiresATimeAboveZeroAndAnUnlimitedOneNeverReducesQuality) {
    EXPECT_TRUE(validate(BlurBudget{}).ok());
    EXPECT_TRUE(validate(BlurBudget{0.1}).ok());
    for (const double wrong : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()})
        EXPECT_FALSE(validate(BlurBudget{wrong}).ok()) << wrong;
    BudgetController controller({}, settingsOf(&getMethod("hybrid")));
    for (const double time : {1.0, 1e9, std::numeric_limits<double>::infinity(), 0.0})
        for (int i = 0; i < 50; ++i) {
            controller.observe(0, time);
            ASSERT_EQ(controller.level(), 0u);
        }
}

TEST(Budget, EveryBudgetIsKeptUnderASteadyLoad) {
    for (const Method* method :
         {&getMethod("hybrid"), &getMethod("gather"), &getMethod("jimenez2014")})
        for (const double budget : {3.0, 6.0, 9.0, 12.0, 15.0, 20.0, 30.0, 40.0, 60.0}) {
            BudgetController controller({budget}, settingsOf(method));
            drive(controller, {}, 400);
            const Drive later = drive(controller, {}, 1000);
            // Now and then it tries the level above, for two frames at most.
            EXPECT_LT(later.shareOver(budget, 0), 0.02) << method->name << ", " << budget << " ms";
            // It does not give up more than two levels that would fit.
            const size_t better = controller.level() >= 2 ? controller.level() - 2 : 0;
            if (controller.level() >= 2) {
                EXPECT_GT(Load{}.of(makeLevels(settingsOf(method))[better]), 0.7 * budget)
                    << method->name << ", " << budget << " ms";
            }
        }
}

TEST(Budget, AChangedLimitKeepsTheLevelAndIsFollowedAndNoLimitRestoresAll) {
    const MotionBlurSettings settings = settingsOf(&getMethod("hybrid"));
    BudgetController steady({12.0}, settings);
    drive(steady, {}, 400);
    BudgetController wavering({12.0}, settings);
    for (int i = 0; i < 400; ++i) {
        wavering.setBudget({i % 2 ? 12.3 : 11.7});
        drive(wavering, {}, 1);
    }
    EXPECT_EQ(wavering.level(), steady.level());
    wavering.setBudget({60.0});
    EXPECT_EQ(wavering.level(), steady.level());
    drive(wavering, {}, 4000);
    EXPECT_EQ(wavering.level(), 0u);
    steady.setBudget({});
    EXPECT_EQ(steady.level(), 0u);
}

TEST(Budget, NoiseCausesNoOscillation) {
    for (uint32_t seed = 1; seed <= 5; ++seed)
        for (const double budget : {8.0, 15.0, 25.0, 38.0}) {
            BudgetController controller({budget}, settingsOf(&getMethod("hybrid")));
            drive(controller, {}, 1000, 0.1, seed);
            const Drive later = drive(controller, {}, 2000, 0.1, seed + 100);
            EXPECT_LE(later.changes(0), 40u) << budget << " ms, seed " << seed;
        }
}

TEST(Budget, ALittleTooMuchCostsOneRungAndFarTooMuchSeveral) {
    BudgetController little({45.0}, settingsOf(&getMethod("hybrid")));
    drive(little, {}, 2);
    EXPECT_EQ(little.level(), 1u);
    BudgetController far({12.0}, settingsOf(&getMethod("hybrid")));
    drive(far, {}, 2);
    EXPECT_GT(far.level(), 3u);
}

TEST(Budget, ASuddenLoadIsJudgedByItselfNotByTheCalmBefore) {
    BudgetController controller({20.0}, settingsOf(&getMethod("hybrid")));
    drive(controller, {0.2, 0.2, 2.0}, 500);
    ASSERT_EQ(controller.level(), 0u);
    drive(controller, {1.0, 1.0, 40.0}, 2);
    EXPECT_GT(controller.level(), 3u);
}

TEST(Budget, TriesThatKeepFailingGrowRare) {
    BudgetController controller({18.0}, settingsOf(&getMethod("hybrid")));
    drive(controller, {1.0, 1.0, 25.0}, 6000);
    EXPECT_LE(drive(controller, {1.0, 1.0, 25.0}, 3000).changes(0), 8u);
}

TEST(Budget, QualityReturnsRungByRungWhenTheLoadDrops) {
    BudgetController controller({20.0}, settingsOf(&getMethod("hybrid")));
    drive(controller, {4.0, 3.0, 200.0}, 300);
    EXPECT_GT(controller.level(), 4u);
    const Drive back = drive(controller, {0.2, 0.2, 2.0}, 3000);
    EXPECT_EQ(controller.level(), 0u);
    for (size_t i = 1; i < back.levels.size(); ++i)
        ASSERT_LE(back.levels[i - 1] - back.levels[i], 1u) << "frame " << i;
}

TEST(Budget, ARungThatWouldJustFitIsNotTriedSoTheMarginStays) {
    BudgetController controller({46.5}, settingsOf(&getMethod("hybrid")));
    drive(controller, {3.0, 3.0, 10.0}, 2); // 58 ms: down by one
    ASSERT_EQ(controller.level(), 1u);
    // All of it would take 46 ms now.
    EXPECT_EQ(drive(controller, {}, 1000).changes(0), 0u);
}

TEST(Budget, StepsUpThatFailedLongAgoDoNotHoldItBackForLong) {
    BudgetController controller({18.0}, settingsOf(&getMethod("hybrid")));
    drive(controller, {1.0, 1.0, 60.0}, 5000);
    ASSERT_GT(controller.level(), 2u);
    drive(controller, {0.2, 0.2, 2.0}, 2000);
    EXPECT_EQ(controller.level(), 0u);
}

TEST(Budget, TheCheapestSettingsHaveNoCheaperRung) {
    MotionBlurSettings settings = settingsOf(&getMethod("own_velocity"), 4);
    EXPECT_EQ(makeLevels(settings).size(), 1u);
    BudgetController controller({0.1}, settings);
    drive(controller, {}, 100);
    EXPECT_EQ(controller.level(), 0u);
}

TEST(Budget, ATimeThatNothingFitsEndsAtTheCheapestBlurAndComesBackFromThere) {
    BudgetController controller({0.5}, settingsOf(&getMethod("gather")));
    drive(controller, {}, 200);
    EXPECT_EQ(controller.level() + 1, controller.levelCount());
    drive(controller, {0.01, 0.01, 0.0}, 4000);
    EXPECT_EQ(controller.level(), 0u);
}

TEST(Budget, TimesOfOtherRungsNoNumbersAndSingleSlowFramesArePassedOver) {
    BudgetController controller({20.0}, settingsOf(&getMethod("hybrid")));
    for (int i = 0; i < 10; ++i) {
        controller.observe(3, 1e6);
        controller.observe(0, std::numeric_limits<double>::quiet_NaN());
        controller.observe(0, std::numeric_limits<double>::infinity());
        controller.observe(0, -5.0);
    }
    EXPECT_EQ(controller.level(), 0u);
    BudgetController calm({50.0}, settingsOf(&getMethod("hybrid")));
    drive(calm, {}, 20);
    calm.observe(0, 500.0);
    drive(calm, {}, 20);
    EXPECT_EQ(calm.level(), 0u);
}

} // namespace shutter::motion_blur
