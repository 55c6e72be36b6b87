// SPDX-License-Identifier: MIT
#include "engine/app/camera_control.h"

#include <gtest/gtest.h>

#include <random>

namespace shutter::app {
namespace {

using math::dvec3;

dvec3 aheadOf(const math::Transform& placement) {
    return placement.rotation * dvec3(0, 0, -1);
}

TEST(CameraControl, AnOrbitLooksAtItsTarget) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    for (int i = 0; i < 100; ++i) {
        OrbitView view{{unit(random), unit(random), unit(random)}, 1.5 + unit(random)};
        view.yaw = 3.0 * unit(random);
        view.pitch = 1.5 * unit(random);
        const math::Transform placement = placementOf(view);
        const dvec3 target = placement.translation + aheadOf(placement) * view.distance;
        EXPECT_NEAR(glm::distance(target, view.target), 0.0, 1e-12);
        const OrbitView back = makeOrbit(placement, view.distance);
        EXPECT_NEAR(glm::distance(back.target, view.target), 0.0, 1e-9);
        EXPECT_NEAR(back.yaw, view.yaw, 1e-9);
        EXPECT_NEAR(back.pitch, view.pitch, 1e-9);
    }
}

TEST(CameraControl, FlyingAheadGoesWhereItLooks) {
    FlyView view{{1.0, 2.0, 3.0}, 0.7, 0.3, 2.0};
    const math::Transform before = placementOf(view);
    InputState input;
    input.down.set(static_cast<size_t>(Key::W));
    steer(view, input, 0.5, 720.0);
    const dvec3 expected = before.translation + aheadOf(before);
    EXPECT_NEAR(glm::distance(view.position, expected), 0.0, 1e-12);
    input.down.set(static_cast<size_t>(Key::Shift));
    steer(view, input, 0.5, 720.0);
    EXPECT_NEAR(glm::distance(view.position, before.translation), 5.0, 1e-12);
}

TEST(CameraControl, DraggingRightTurnsToTheRightAndNeverOverTheTop) {
    FlyView view;
    InputState input;
    input.buttons.set(static_cast<size_t>(MouseButton::Right));
    input.pointerMovePx = {50.0, 0.0};
    steer(view, input, 0.0, 500.0);
    EXPECT_GT(aheadOf(placementOf(view)).x, 0.1);
    input.pointerMovePx = {0.0, -1e6};
    steer(view, input, 0.0, 500.0);
    EXPECT_DOUBLE_EQ(view.pitch, kMaxPitch);
}

TEST(CameraControl, TheWheelComesNearerAndStopsShortOfTheTarget) {
    OrbitView view;
    InputState input;
    input.wheel = 3.0;
    steer(view, input, 0.0, 500.0);
    EXPECT_LT(view.distance, 0.7);
    input.wheel = 1e6;
    steer(view, input, 0.0, 500.0);
    EXPECT_GT(view.distance, 0.0);
}

} // namespace
} // namespace shutter::app
