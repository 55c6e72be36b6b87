// SPDX-License-Identifier: MIT
#include "game/demos/gallery_aim.h"

#include <algorithm>

namespace shutter::game {

using math::dvec3;

namespace {

constexpr double kTurnRate = 0.9;   // rad/s
constexpr double kPitchRate = 0.5;  // rad/s
constexpr double kSpring = 260.0;   // 1/s^2
constexpr double kDamping = 20.0;   // 1/s: below critical, it swings through once
constexpr double kRecoilRate = 1.5; // rad/s, at a throw
constexpr double kKickRate = 2.6;   // m/s

void stepBack(double& value, double& rate) {
    constexpr double dt = kDemoStepSeconds;
    rate += (-kSpring * value - kDamping * rate) * dt;
    value += rate * dt;
}

} // namespace

void stepAim(Aim& aim, const DemoControls& controls) {
    constexpr double dt = kDemoStepSeconds;
    aim.yaw = std::clamp(aim.yaw + controls.turn * kTurnRate * dt, -kMaxYaw, kMaxYaw);
    aim.pitch = std::clamp(aim.pitch + controls.drive * kPitchRate * dt, -kMaxPitch, kMaxPitch);
    stepBack(aim.recoil, aim.recoilRate);
    stepBack(aim.kick, aim.kickRate);
}

void kickBack(Aim& aim) {
    aim.recoilRate += kRecoilRate;
    aim.kickRate += kKickRate;
}

math::Transform aimPose(const Aim& aim, const math::Transform& rest) {
    return {
        rest.translation,
        glm::angleAxis(-aim.yaw, dvec3(0.0, 1.0, 0.0)) * rest.rotation *
            glm::angleAxis(aim.pitch + aim.recoil, dvec3(1.0, 0.0, 0.0))};
}

math::Transform launcherPose(const Aim& aim, const math::Transform& rest) {
    return {
        rest.translation + dvec3(0.0, 0.0, aim.kick),
        rest.rotation * glm::angleAxis(0.8 * aim.recoil, dvec3(1.0, 0.0, 0.0))};
}

} // namespace shutter::game
