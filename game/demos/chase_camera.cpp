// SPDX-License-Identifier: MIT
#include "game/demos/chase_camera.h"

#include <cmath>

namespace shutter::game {

using math::dvec3;

namespace {

constexpr double kHeadingSpring = 22.0;  // 1/s^2
constexpr double kDistanceSpring = 30.0; // 1/s^2
constexpr double kNearest = 5.0;         // metres, at rest
constexpr double kPerSpeed = 0.035;      // metres for each m/s
constexpr double kHeight = 1.5;          // metres
constexpr double kPitch = 0.0;           // radians, upwards: half of the picture is sky

/// Semi-implicit and damped critically: it never overshoots by itself.
void stepSpring(double& value, double& rate, double target, double spring) {
    constexpr double dt = kDemoStepSeconds;
    rate += (spring * (target - value) - 2.0 * std::sqrt(spring) * rate) * dt;
    value += rate * dt;
}

} // namespace

void stepChase(ChaseCamera& camera, const CarState& car) {
    stepSpring(camera.heading, camera.headingRate, car.heading, kHeadingSpring);
    const double target = kNearest + kPerSpeed * glm::length(car.velocity);
    stepSpring(camera.distance, camera.distanceRate, target, kDistanceSpring);
}

math::Transform chasePose(const ChaseCamera& camera, const CarState& car) {
    const dvec3 back(std::sin(camera.heading), 0.0, std::cos(camera.heading));
    const dvec3 place = dvec3(car.place.x, kHeight, car.place.y) + back * camera.distance;
    return {
        place,
        glm::angleAxis(camera.heading, dvec3(0.0, 1.0, 0.0)) *
            glm::angleAxis(kPitch, dvec3(1.0, 0.0, 0.0))};
}

} // namespace shutter::game
