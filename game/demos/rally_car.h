// SPDX-License-Identifier: MIT
// A car on a plane: one steered track of two wheels (the "bicycle" model) with Coulomb friction
// sideways. Metres, seconds, radians; x to the right, z towards the viewer, as in the world.
#pragma once

#include "engine/math/math.h"
#include "engine/math/transform.h"
#include "game/demos/demo.h"

namespace shutter::game {

inline constexpr double kWheelRadius = 0.34;   ///< metres
inline constexpr double kCarHalfLength = 1.9;  ///< metres
inline constexpr double kCarHalfWidth = 0.95;  ///< metres
inline constexpr double kCarMostSpeed = 32.0;  ///< m/s, where thrust and drag are equal
inline constexpr double kCarBrakeDecel = 13.0; ///< m/s^2

/// Component: the player's car.
struct CarState {
    math::dvec2 place{0.0};    ///< x, z
    math::dvec2 velocity{0.0}; ///< m/s
    double heading = 0.0;      ///< about +Y; 0 is -Z; not wrapped after whole turns
    double steer = 0.0;        ///< of the front wheels, positive to the right
    double frontRoll = 0.0;    ///< angle that the front wheels have rolled by, [0, 2 pi)
    double rearRoll = 0.0;     ///< as above; does not change while the hand brake is held
    double pitch = 0.0;        ///< of the body, positive: nose up
    double roll = 0.0;         ///< of the body, positive: leans to the right

    [[nodiscard]] math::dvec2 forward() const;
    [[nodiscard]] math::dvec2 right() const;

    /// Along the heading, m/s; negative backwards.
    [[nodiscard]] double speed() const { return glm::dot(velocity, forward()); }
};

/// One step of kDemoStepSeconds. Controls in their ranges.
/// \param onRoad false: less grip, more drag
void stepCar(CarState& car, const DemoControls& controls, bool onRoad);

/// The pose of the car's root, which lies on the ground.
[[nodiscard]] math::Transform carPose(const CarState& car);
/// The pose of the body, which leans from `rest`.
[[nodiscard]] math::Transform bodyPose(const CarState& car, const math::Transform& rest);
/// The pose of a wheel relative to the root: at the place of `rest`, steered. The axle is Z of the
/// mesh.
[[nodiscard]] math::Transform
wheelPose(const CarState& car, const math::Transform& rest, bool isFront);
/// The pose of the spokes relative to the wheel, which makes them roll.
[[nodiscard]] math::Transform spokesPose(const CarState& car, bool isFront);

/// A camera on two springs behind a car: one turns it round, one holds its distance.
struct ChaseCamera {
    double heading = 0.0;      ///< as CarState's
    double headingRate = 0.0;  ///< rad/s
    double distance = 5.4;     ///< metres behind the car's middle
    double distanceRate = 0.0; ///< m/s
};

/// One step of kDemoStepSeconds.
void stepChase(ChaseCamera& camera, const CarState& car);

/// The pose of the camera's entity, a root, with -Z forward.
[[nodiscard]] math::Transform chasePose(const ChaseCamera& camera, const CarState& car);

} // namespace shutter::game
