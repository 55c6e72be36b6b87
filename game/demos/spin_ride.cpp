// SPDX-License-Identifier: MIT
#include "game/demos/spin_ride.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace shutter::game {

namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr double kRideThrust = 1.1;    // rad/s^2
constexpr double kBrake = 1.8;         // rad/s^2
constexpr double kRideFriction = 0.06; // 1/s
constexpr double kPointsPerSecond = 20.0;
constexpr double kRingPoints = 40.0; // for each rad/s at which it is caught
constexpr double kMissPoints = -15.0;
constexpr double kSlowestTarget = 0.9; // rad/s
constexpr double kFastestTarget = 3.0; // rad/s
constexpr double kMinChange = 0.5;     // rad/s between two targets

double turnBy(double angle, double by) {
    const double turned = angle + by;
    return turned - kTurn * std::floor(turned / kTurn);
}

} // namespace

double wrapAngle(double radians) {
    return radians - kTurn * std::floor(radians / kTurn + 0.5);
}

void stepRide(Ride& ride, const DemoControls& controls) {
    constexpr double dt = kDemoStepSeconds;
    const double force = controls.drive > 0.0 ? kRideThrust : kBrake;
    ride.rate += (controls.drive * force - kRideFriction * ride.rate) * dt;
    ride.rate = std::clamp(ride.rate, 0.0, kMaxRideRate);
    ride.carousel = turnBy(ride.carousel, ride.rate * dt);
    ride.fan = turnBy(ride.fan, kFanGear * ride.rate * dt);
    ride.mill = turnBy(ride.mill, kMillGear * ride.rate * dt);
}

void stepRules(RideRules& rules, const Ride& ride, double horse, bool action, Random& random) {
    constexpr double dt = kDemoStepSeconds;
    if (std::abs(ride.rate - rules.targetRate) <= kRateTolerance)
        rules.matched += kPointsPerSecond * dt;
    if (action && !rules.wasHeld) {
        const bool reaches = std::abs(wrapAngle(horse)) <= kRingReach;
        rules.caught += reaches;
        rules.missed += !reaches;
        rules.ringPoints += reaches ? kRingPoints * ride.rate : kMissPoints;
    }
    rules.wasHeld = action;
    rules.sinceChange += dt;
    if (rules.sinceChange < kTargetSeconds)
        return;
    rules.sinceChange = 0.0;
    const double before = rules.targetRate;
    while (std::abs(rules.targetRate - before) < kMinChange)
        rules.targetRate = random.between(kSlowestTarget, kFastestTarget);
}

int countPoints(const RideRules& rules) {
    return static_cast<int>(std::floor(rules.matched + rules.ringPoints));
}

} // namespace shutter::game
