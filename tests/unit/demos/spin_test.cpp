// SPDX-License-Identifier: MIT
#include "game/demos/spin_ride.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>

namespace shutter::game {
namespace {

constexpr double kPi = std::numbers::pi;

TEST(Ride, SpeedsUpBrakesAndStopsAtItsBounds) {
    Ride ride;
    for (int i = 0; i < kDemoStepsPerSecond * 10; ++i)
        stepRide(ride, {.drive = 1.0});
    EXPECT_EQ(ride.rate, kMostRideRate);
    for (int i = 0; i < kDemoStepsPerSecond * 10; ++i)
        stepRide(ride, {.drive = -1.0});
    EXPECT_EQ(ride.rate, 0.0);
}

TEST(Ride, WithoutDriveItSlowsDown) {
    Ride ride{.rate = 2.0};
    double before = ride.rate;
    for (int i = 0; i < kDemoStepsPerSecond; ++i) {
        stepRide(ride, {});
        ASSERT_LT(ride.rate, before);
        before = ride.rate;
    }
}

TEST(Ride, GearsTurnTogetherAndNoStepIsHalfATurn) {
    Ride ride{.rate = 2.0};
    stepRide(ride, {});
    EXPECT_NEAR(ride.fan, kFanGear * ride.carousel, 1e-12);
    EXPECT_NEAR(wrapAngle(ride.mill), kMillGear * ride.carousel, 1e-12);
    EXPECT_LT(kMostRideRate * kFanGear * kDemoStepSeconds, kPi);
}

TEST(RideRules, KeepingTheRateScoresByTheSecond) {
    Random random(1);
    RideRules near;
    RideRules far;
    for (int i = 0; i < kDemoStepsPerSecond; ++i) {
        stepRules(near, {.rate = near.targetRate + 0.9 * kRateTolerance}, 1.0, false, random);
        stepRules(far, {.rate = far.targetRate + 1.1 * kRateTolerance}, 1.0, false, random);
    }
    EXPECT_NEAR(near.matched, 20.0, 1e-6);
    EXPECT_EQ(far.matched, 0.0);
}

TEST(RideRules, ARingIsCaughtOncePerGrabAndAMissCosts) {
    Random random(1);
    RideRules rules{.targetRate = 9.0};
    const Ride ride{.rate = 2.0};
    stepRules(rules, ride, 0.1, true, random);
    stepRules(rules, ride, 0.1, true, random);
    EXPECT_EQ(rules.caught, 1) << "held on is not grabbed again";
    stepRules(rules, ride, 0.1, false, random);
    stepRules(rules, ride, 2.0 * kPi - 0.1, true, random);
    EXPECT_EQ(rules.caught, 2) << "just before the ring";
    EXPECT_EQ(countPoints(rules), 160);
    stepRules(rules, ride, 0.1, false, random);
    stepRules(rules, ride, kPi, true, random);
    EXPECT_EQ(rules.missed, 1);
    EXPECT_EQ(countPoints(rules), 145);
}

TEST(RideRules, AnotherRateIsAskedForEveryNineSeconds) {
    Random random(1);
    RideRules rules;
    std::set<double> rates;
    for (int i = 0; i < kDemoStepsPerSecond * 44; ++i) {
        stepRules(rules, {}, 1.0, false, random);
        rates.insert(rules.targetRate);
        ASSERT_GT(rules.targetRate, 0.5);
        ASSERT_LT(rules.targetRate, kMostRideRate - kRateTolerance);
    }
    EXPECT_EQ(rates.size(), 5u);
}

TEST(WrapAngle, LeavesOutWholeTurns) {
    EXPECT_NEAR(wrapAngle(2.0 * kPi + 0.3), 0.3, 1e-12);
    EXPECT_NEAR(wrapAngle(-0.3), -0.3, 1e-12);
    EXPECT_NEAR(wrapAngle(1.5 * kPi), -0.5 * kPi, 1e-12);
    EXPECT_NEAR(wrapAngle(kPi), -kPi, 1e-12);
}

} // namespace
} // namespace shutter::game
