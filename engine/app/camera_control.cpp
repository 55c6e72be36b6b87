// SPDX-License-Identifier: MIT
#include "engine/app/camera_control.h"

#include <algorithm>
#include <cmath>

namespace shutter::app {

namespace {

/// A drag over the whole height of the window turns by this.
constexpr double kDragRadians = 3.0;
constexpr double kPadRadiansPerSecond = 2.0;
constexpr double kKeyRadiansPerSecond = 1.5;
/// Factor of the distance or the speed per step of the wheel.
constexpr double kWheelFactor = 1.15;
constexpr double kFastFactor = 4.0;

math::dquat turnOf(double yaw, double pitch) {
    return glm::angleAxis(yaw, math::dvec3(0, 1, 0)) * glm::angleAxis(pitch, math::dvec3(1, 0, 0));
}

/// Yaw and pitch of where -Z of the placement points.
math::dvec2 anglesOf(const math::Transform& placement) {
    const math::dvec3 ahead = placement.rotation * math::dvec3(0, 0, -1);
    const double pitch = std::asin(std::clamp(ahead.y, -1.0, 1.0));
    return {std::atan2(-ahead.x, -ahead.z), std::clamp(pitch, -kMaxPitch, kMaxPitch)};
}

void turn(double& yaw, double& pitch, const math::dvec2& radians) {
    yaw = std::remainder(yaw - radians.x, 2.0 * 3.14159265358979323846);
    pitch = std::clamp(pitch + radians.y, -kMaxPitch, kMaxPitch);
}

} // namespace

math::Transform placementOf(const OrbitView& view) {
    math::Transform placement;
    placement.rotation = turnOf(view.yaw, view.pitch);
    placement.translation = view.target + placement.rotation * math::dvec3(0, 0, view.distance);
    return placement;
}

math::Transform placementOf(const FlyView& view) {
    math::Transform placement;
    placement.rotation = turnOf(view.yaw, view.pitch);
    placement.translation = view.position;
    return placement;
}

OrbitView makeOrbit(const math::Transform& placement, double distance) {
    OrbitView view;
    const math::dvec2 angles = anglesOf(placement);
    view.yaw = angles.x;
    view.pitch = angles.y;
    view.distance = distance;
    view.target =
        placement.translation + turnOf(view.yaw, view.pitch) * math::dvec3(0, 0, -distance);
    return view;
}

FlyView makeFly(const math::Transform& placement, double speed) {
    const math::dvec2 angles = anglesOf(placement);
    return {placement.translation, angles.x, angles.y, speed};
}

void steer(OrbitView& view, const InputState& input, double seconds, double heightPx) {
    const math::dvec2 drag = input.pointerMovePx / heightPx;
    math::dvec2 turned = input.pad.rightStick * kPadRadiansPerSecond * seconds;
    turned.x -= axisOf(input, Key::A, Key::D) * kKeyRadiansPerSecond * seconds;
    if (input.isDown(MouseButton::Left))
        turned += math::dvec2(drag.x, -drag.y) * kDragRadians;
    turn(view.yaw, view.pitch, turned);
    if (input.isDown(MouseButton::Right) || input.isDown(MouseButton::Middle))
        view.target +=
            turnOf(view.yaw, view.pitch) * math::dvec3(-drag.x, drag.y, 0.0) * view.distance;
    const double nearer =
        input.wheel + (axisOf(input, Key::S, Key::W) + input.pad.leftStick.y) * seconds / 0.1;
    view.distance = std::clamp(view.distance * std::pow(kWheelFactor, -nearer), 1e-4, 1e7);
}

void steer(FlyView& view, const InputState& input, double seconds, double heightPx) {
    const math::dvec2 drag = input.pointerMovePx / heightPx;
    math::dvec2 turned = input.pad.rightStick * kPadRadiansPerSecond * seconds;
    if (input.isDown(MouseButton::Right))
        turned += math::dvec2(drag.x, -drag.y) * kDragRadians;
    turn(view.yaw, view.pitch, turned);
    view.speed = std::clamp(view.speed * std::pow(kWheelFactor, input.wheel), 1e-4, 1e5);
    const math::dvec3 wanted(
        axisOf(input, Key::A, Key::D) + input.pad.leftStick.x,
        axisOf(input, Key::Q, Key::E) + input.pad.rightTrigger - input.pad.leftTrigger,
        axisOf(input, Key::W, Key::S) - input.pad.leftStick.y
    );
    const double speed = view.speed * (input.isDown(Key::Shift) ? kFastFactor : 1.0);
    view.position += turnOf(view.yaw, view.pitch) * wanted * speed * seconds;
}

} // namespace shutter::app
