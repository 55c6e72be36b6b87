// SPDX-License-Identifier: MIT
// Cameras in the player's hand: round a place, or free in the air.
#pragma once

#include "engine/app/input.h"
#include "engine/math/math.h"
#include "engine/math/transform.h"

namespace shutter::app {

/// A camera that orbits a target.
struct OrbitView {
    math::dvec3 target{0.0}; ///< metres
    double distance = 1.0;   ///< metres, above 0
    double yaw = 0.0;        ///< radians to the left of -Z
    double pitch = 0.0;      ///< radians upwards, [-kMaxPitch, kMaxPitch]
};

/// A camera that flies freely.
struct FlyView {
    math::dvec3 position{0.0}; ///< metres
    double yaw = 0.0;          ///< radians to the left of -Z
    double pitch = 0.0;        ///< radians upwards, [-kMaxPitch, kMaxPitch]
    double speed = 1.0;        ///< metres a second
};

/// Just short of straight up, where yaw has no meaning.
inline constexpr double kMaxPitch = 1.55;

[[nodiscard]] math::Transform placementOf(const OrbitView& view);
[[nodiscard]] math::Transform placementOf(const FlyView& view);

/// Returns the orbit view that matches the direction of a camera at `placement`, without its roll.
/// \param distance above 0
[[nodiscard]] OrbitView makeOrbit(const math::Transform& placement, double distance);
[[nodiscard]] FlyView makeFly(const math::Transform& placement, double speed);

/// One frame of a hand on the controls: drag with the left button turns, with the right or middle
/// one moves the target, the wheel and W, S come nearer; A, D and the pad's right stick turn.
/// \param seconds that the frame took
/// \param heightPx of the window, above 0
void steer(OrbitView& view, const InputState& input, double seconds, double heightPx);
/// Dragging with the right button turns the view; W, A, S, D, Q and E move it; the pad's sticks do
/// both; Shift is faster, the wheel sets the speed.
void steer(FlyView& view, const InputState& input, double seconds, double heightPx);

} // namespace shutter::app
