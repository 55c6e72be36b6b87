// SPDX-License-Identifier: MIT
#pragma once

#include "engine/math/transform.h"
#include "game/demos/demo.h"

namespace shutter::game {

/// The player's view direction, and the remaining recoil of the last throws.
struct Aim {
    double yaw = 0.0;        ///< radians, positive to the right, within kMaxYaw
    double pitch = 0.0;      ///< radians, positive up, within kMaxPitch
    double recoil = 0.0;     ///< radians upwards, springs back to 0
    double recoilRate = 0.0; ///< rad/s
    double kick = 0.0;       ///< metres that the launcher is thrust back, springs back to 0
    double kickRate = 0.0;   ///< m/s
};

inline constexpr double kMaxYaw = 0.75;   ///< radians
inline constexpr double kMaxPitch = 0.45; ///< radians

/// One step of kDemoStepSeconds.
void stepAim(Aim& aim, const DemoControls& controls);
/// The kick of a throw.
void kickBack(Aim& aim);

/// The camera's pose: `rest` turned by the aim.
[[nodiscard]] math::Transform aimPose(const Aim& aim, const math::Transform& rest);
/// The launcher's pose relative to the camera.
[[nodiscard]] math::Transform launcherPose(const Aim& aim, const math::Transform& rest);

} // namespace shutter::game
