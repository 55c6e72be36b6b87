// SPDX-License-Identifier: MIT
#include "game/bench/measure.h"
#include "game/bench/sequence_plan.h"

#include <gtest/gtest.h>

#include <initializer_list>
#include <set>
#include <string>
#include <vector>

namespace shutter::bench {
namespace {

std::vector<const game::MethodInfo*> findMethods(std::initializer_list<const char*> names) {
    std::vector<const game::MethodInfo*> methods;
    for (const char* name : names)
        methods.push_back(findContender(name).value());
    return methods;
}

TEST(SequencePlan, NoSampleCountIsDrawnTwiceInAFrame) {
    const SequencePlan plan =
        planSequence(findMethods({"sharp", "gather", "accumulate", "truth"}), 48, 64);
    std::set<std::string> keys;
    for (const auto* points : {&plan.points, &plan.sweep})
        for (const SamplePoint& point : *points)
            EXPECT_TRUE(keys.insert(makeKey(point)).second) << makeKey(point);
    for (const char* key :
         {"sharp/0",
          "gather/15",
          "gather/64",
          "accumulate/8",
          "accumulate/32",
          "truth/4",
          "truth/8"})
        EXPECT_TRUE(keys.contains(key)) << key;
    EXPECT_FALSE(keys.contains("truth/16")) << "seconds a frame";
    EXPECT_FALSE(keys.contains("accumulate/64")) << "the truth itself";
    EXPECT_EQ(plan.points.size(), 4u);
}

TEST(SequencePlan, FramesThatAreDrawnAgainLieInsideTheFilm) {
    for (const uint32_t frames : {2u, 3u, 7u, 48u}) {
        const SequencePlan plan = planSequence(findMethods({"sharp"}), frames, 64);
        EXPECT_GE(plan.standingFrames, 2u);
        EXPECT_LE(plan.firstStanding + plan.standingFrames, frames);
        ASSERT_FALSE(plan.sweepFrames.empty());
        EXPECT_LT(plan.sweepFrames.back(), frames);
        EXPECT_EQ(
            std::set(plan.sweepFrames.begin(), plan.sweepFrames.end()).size(),
            plan.sweepFrames.size()
        );
        for (const uint32_t frame : plan.sweepFrames)
            EXPECT_TRUE(plan.isSwept(frame));
    }
    EXPECT_EQ(
        planSequence(findMethods({"sharp"}), 48, 64).sweepFrames,
        (std::vector<uint32_t>{6, 18, 30, 42})
    );
}

TEST(SequencePlan, HdrFlipIsOfEveryFourthFrameOfTheFilmItself) {
    for (const uint32_t frame : {0u, 4u, 44u})
        EXPECT_TRUE(SequencePlan::isJudgedLinear(SequenceCamera::Own, frame));
    for (const uint32_t frame : {1u, 2u, 3u, 6u})
        EXPECT_FALSE(SequencePlan::isJudgedLinear(SequenceCamera::Own, frame));
    EXPECT_FALSE(SequencePlan::isJudgedLinear(SequenceCamera::Standing, 0));
}

TEST(SequencePlan, TheProgressBarCountsEveryPicture) {
    const SequencePlan plan = planSequence(findMethods({"sharp", "gather"}), 48, 64);
    // A truth and two methods in 48 and 12 frames; gather at 4, 8, 16, 32 and 64 in four.
    EXPECT_EQ(countPictures(plan), 3u * 60u + 5u * 4u);
}

} // namespace
} // namespace shutter::bench
