// SPDX-License-Identifier: MIT
// The carousel with its attached objects, and the rules of riding it.
#pragma once

#include "game/demos/demo.h"
#include "game/demos/random.h"

namespace shutter::game {

inline constexpr double kMaxRideRate = 3.4; ///< rad/s of the carousel
inline constexpr double kFanGear = 9.0;     ///< turns of the fan for one of the carousel
inline constexpr double kMillGear = -0.7;   ///< of the wind wheel, against it

/// Angles in [0, 2 pi); those of fan and wind wheel are the carousel's times their gear.
struct Ride {
    double rate = 0.0;     ///< rad/s, of the carousel, [0, kMaxRideRate]
    double carousel = 0.0; ///< radians, counter-clockwise from above
    double fan = 0.0;      ///< radians
    double mill = 0.0;     ///< radians
};

/// One step of kDemoStepSeconds: `drive` speeds up or brakes, friction slows.
void stepRide(Ride& ride, const DemoControls& controls);

/// The game: keep the carousel at the demanded rate, and catch the ring whenever the
/// golden horse passes it.
struct RideRules {
    double targetRate = 1.2;  ///< rad/s
    double sinceChange = 0.0; ///< seconds
    double matched = 0.0;     ///< points for keeping the rate
    int caught = 0;           ///< rings
    int missed = 0;           ///< missed grabs
    double ringPoints = 0.0;  ///< of all grabs
    bool wasHeld = false;     ///< the action, in the step before
};

inline constexpr double kRateTolerance = 0.15; ///< rad/s: tolerance of the rate
inline constexpr double kRingReach = 0.20;     ///< radians from the ring: a grab catches it
inline constexpr double kTargetSeconds = 9.0;  ///< until another rate is demanded

/// \param horse angle of the golden horse from the ring, radians
void stepRules(RideRules& rules, const Ride& ride, double horse, bool action, Random& random);

[[nodiscard]] int countPoints(const RideRules& rules);

/// The angle, whole turns left out, [-pi, pi).
[[nodiscard]] double wrapAngle(double radians);

} // namespace shutter::game
