// SPDX-License-Identifier: MIT
#include "game/demos/rally_car.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace shutter::game {

using math::dquat;
using math::dvec2;
using math::dvec3;
using math::Transform;

namespace {

constexpr double kWheelBase = 2.44;    // metres
constexpr double kThrust = 9.5;        // m/s^2 at rest
constexpr double kReverseSpeed = 7.0;  // m/s
constexpr double kReverseThrust = 4.0; // m/s^2
constexpr double kRolling = 0.35;      // m/s^2
constexpr double kRoadGrip = 1.15;     // friction sideways over weight
constexpr double kMeadowGrip = 0.65;
constexpr double kMeadowDrag = 0.28;  // 1/s
constexpr double kSlidingGrip = 0.45; // of the grip, with the hand brake on
constexpr double kHandBrake = 4.5;    // m/s^2
constexpr double kMaxSteer = 0.52;    // rad
constexpr double kSteerRate = 2.4;    // rad/s
/// Drag that holds the thrust at kCarMostSpeed.
constexpr double kDrag = (kThrust - kRolling) / (kCarMostSpeed * kCarMostSpeed);

const dvec3 kX(1.0, 0.0, 0.0);
const dvec3 kY(0.0, 1.0, 0.0);
const dvec3 kZ(0.0, 0.0, 1.0);

double approach(double value, double target, double most) {
    return value + std::clamp(target - value, -most, most);
}

/// Along the heading after one step: thrust or brakes, then what slows in any case, never past 0.
double stepSpeed(double speed, const DemoControls& controls, bool onRoad) {
    constexpr double dt = kDemoStepSeconds;
    double slowing = kRolling + (onRoad ? 0.0 : kMeadowDrag * std::abs(speed));
    if (controls.action)
        slowing += kHandBrake;
    if (controls.drive * speed < 0.0)
        slowing += kCarBrakeDecel * std::abs(controls.drive);
    else if (controls.drive > 0.0)
        speed += kThrust * controls.drive * dt;
    else if (speed > -kReverseSpeed)
        speed += kReverseThrust * controls.drive * dt;
    speed -= kDrag * speed * std::abs(speed) * dt;
    return approach(speed, 0.0, slowing * dt);
}

double wrapTurn(double radians) {
    constexpr double kTurn = 2.0 * std::numbers::pi;
    return radians - kTurn * std::floor(radians / kTurn);
}

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

dvec2 CarState::forward() const {
    return {-std::sin(heading), -std::cos(heading)};
}

dvec2 CarState::right() const {
    return {std::cos(heading), -std::sin(heading)};
}

void stepCar(CarState& car, const DemoControls& controls, bool onRoad) {
    constexpr double dt = kDemoStepSeconds;
    const double grip =
        kGravity * (onRoad ? kRoadGrip : kMeadowGrip) * (controls.action ? kSlidingGrip : 1.0);
    const double before = car.speed();
    // Beyond the tyres' grip at this speed more lock would only scrub.
    const double useful =
        std::atan(kWheelBase * 1.1 * kRoadGrip * kGravity / std::max(before * before, 1.0e-3));
    const double lock = std::min(kMaxSteer, useful);
    car.steer = approach(car.steer, controls.turn * lock, kSteerRate * dt);

    const double speed = stepSpeed(before, controls, onRoad);
    double turnRate = speed * std::tan(car.steer) / kWheelBase; // positive to the right
    const double held =
        (controls.action ? 1.7 / kSlidingGrip : 1.0) * grip / std::max(std::abs(speed), 1.0);
    turnRate = std::clamp(turnRate, -held, held);
    car.heading -= turnRate * dt;
    // The velocity keeps its direction while the car turns; friction sideways pulls it round.
    const double along = glm::dot(car.velocity, car.forward());
    const double across = approach(glm::dot(car.velocity, car.right()), 0.0, grip * dt);
    car.velocity = car.forward() * (along + (speed - before)) + car.right() * across;
    car.place += car.velocity * dt;

    car.frontRoll = wrapTurn(car.frontRoll + speed / kWheelRadius * dt);
    if (!controls.action)
        car.rearRoll = wrapTurn(car.rearRoll + speed / kWheelRadius * dt);
    // The body leans out of the deform and dives under the brakes, with a lag of its springs.
    const double leanTo = std::clamp(-turnRate * speed * 0.006, -0.07, 0.07);
    const double pitchTo = std::clamp((speed - before) / dt * 0.004, -0.05, 0.04);
    car.roll += (leanTo - car.roll) * 6.0 * dt;
    car.pitch += (pitchTo - car.pitch) * 6.0 * dt;
}

Transform carPose(const CarState& car) {
    return {{car.place.x, 0.0, car.place.y}, glm::angleAxis(car.heading, kY)};
}

Transform bodyPose(const CarState& car, const Transform& rest) {
    return {rest.translation, glm::angleAxis(-car.roll, kZ) * glm::angleAxis(car.pitch, kX)};
}

Transform wheelPose(const CarState& car, const Transform& rest, bool isFront) {
    const dquat axle = glm::angleAxis(std::numbers::pi / 2.0, kY);
    const dquat steered = glm::angleAxis(isFront ? -car.steer : 0.0, kY);
    return {rest.translation, steered * axle};
}

Transform spokesPose(const CarState& car, bool isFront) {
    return {dvec3(0.0), glm::angleAxis(-(isFront ? car.frontRoll : car.rearRoll), kZ)};
}

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
