// SPDX-License-Identifier: MIT
#include "engine/app/step_clock.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

namespace shutter::app {
namespace {

constexpr double kStep = 1.0 / 120.0;

TEST(StepClock, WhatIsDrawnIsNeverAheadOfWhatIsSimulated) {
    StepClock clock(kStep);
    std::mt19937 random(3);
    std::uniform_real_distribution<double> wall(0.0, 0.05);
    uint64_t steps = 0;
    double last = 0.0;
    for (int i = 0; i < 2000; ++i) {
        const FrameTime frame = clock.advance(wall(random));
        steps += frame.steps;
        EXPECT_LE(frame.seconds, double(steps) * kStep + 1e-7);
        EXPECT_GT(frame.seconds, (double(steps) - 1.0) * kStep - 1e-7);
        EXPECT_GE(frame.seconds, last);
        last = frame.seconds;
    }
}

TEST(StepClock, FramesOfWholeStepsTakeJustThese) {
    StepClock clock(kStep);
    for (int i = 0; i < 10'000; ++i)
        ASSERT_EQ(clock.advance(4.0 * kStep).steps, 4u) << i;
}

TEST(StepClock, APausedGameStandsAndKeepsItsFrame) {
    StepClock clock(kStep);
    (void)clock.advance(1.0 / 60.0);
    clock.setPaused(true);
    const FrameTime paused = clock.advance(1.0);
    EXPECT_EQ(paused.steps, 0u);
    EXPECT_DOUBLE_EQ(paused.seconds, 1.0 / 60.0);
    EXPECT_DOUBLE_EQ(paused.duration, 1.0 / 60.0); // its blur stays to be looked at
    clock.stepOnce(1.0 / 60.0);
    const FrameTime stepped = clock.advance(1.0);
    EXPECT_EQ(stepped.steps, 2u);
    EXPECT_EQ(clock.advance(1.0).steps, 0u);
}

TEST(StepClock, SlowMotionShortensTheFrame) {
    StepClock clock(kStep);
    clock.setSpeed(0.25);
    const FrameTime frame = clock.advance(0.04);
    EXPECT_DOUBLE_EQ(frame.duration, 0.01);
    clock.setSpeed(0.0);
    EXPECT_EQ(clock.speed(), 0.01);
}

TEST(StepClock, AHitchIsNotMadeUpFor) {
    StepClock clock(kStep);
    EXPECT_EQ(clock.advance(60.0).steps, 30u);
    EXPECT_EQ(clock.advance(-1.0).steps, 0u);
    EXPECT_EQ(clock.advance(std::numeric_limits<double>::quiet_NaN()).steps, 0u);
    EXPECT_EQ(clock.advance(std::numeric_limits<double>::infinity()).steps, 30u);
}

} // namespace
} // namespace shutter::app
