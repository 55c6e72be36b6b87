// SPDX-License-Identifier: MIT
#include "engine/scene/auto_focus.h"
#include "engine/scene/lens.h"
#include "engine/scene/motion.h"
#include "engine/scene/path.h"
#include "game/play/loop/viewer_camera.h"

#include <gtest/gtest.h>

namespace shutter::game {
namespace {

using app::Key;
using math::dvec3;

class Viewer : public testing::Test {
  protected:
    Viewer() {
        const ecs::Entity like = mWorld.registry.create();
        mWorld.registry.add(like, scene::Camera{});
        math::Transform placement;
        placement.translation = {0, 1, 5};
        mWorld.registry.add(like, scene::LocalTransform{placement});
        mCamera = std::make_unique<ViewerCamera>(mWorld, like, 5.0, 0.0);
        mCamera->setMode(ViewerMode::Fly);
    }

    void advance(double seconds, bool ahead, bool paused = false) {
        app::InputState input;
        input.down.set(static_cast<size_t>(Key::W), ahead);
        mCamera->advance(mWorld, input, seconds, kFrame, kFrame, 500.0, paused);
    }

    dvec3 at(double seconds) {
        return dvec3(worldFromEntity(mWorld, mCamera->entity(), seconds)[3]);
    }

    static constexpr double kFrame = 0.1;
    scene::World mWorld;
    std::unique_ptr<ViewerCamera> mCamera;
};

TEST_F(Viewer, TheViewerStartsAtTheOtherCamera) {
    advance(0.0, false);
    EXPECT_NEAR(glm::distance(at(0.0), dvec3(0, 1, 5)), 0.0, 1e-9);
    EXPECT_EQ(at(-1.0), at(0.0));
}

TEST_F(Viewer, ItHasTheLensOfTheOtherCameraHoweverThatIsFocused) {
    const auto see = [&](ecs::Entity like) {
        const ViewerCamera viewer(mWorld, like, 5.0, 0.5);
        scene::advanceAutoFocus(mWorld, 0.5);
        return scene::lensAt(mWorld, viewer.entity(), 0.5);
    };
    const ecs::Entity like = mWorld.registry.create();
    mWorld.registry.add(like, scene::Camera{});
    mWorld.registry.add(like, scene::LocalTransform{});
    EXPECT_EQ(see(like).fStop, 0.0);
    mWorld.registry.add(like, scene::CameraLens{.fStop = 2.0, .focusDistance = 7.0});
    EXPECT_EQ(see(like).focusDistance, 7.0);
    const ecs::Entity target = mWorld.registry.create();
    mWorld.registry.add(target, scene::LocalTransform{{.translation = {0, 0, -4}}});
    mWorld.registry.add(like, scene::AutoFocus{target});
    EXPECT_DOUBLE_EQ(see(like).focusDistance, 4.0);
    EXPECT_EQ(see(like).fStop, 2.0);
    mWorld.registry.add(like, scene::FocusMotion{{{0.0, 1.5, 4.0, false}}});
    EXPECT_EQ(see(like).focusDistance, 1.5) << "keys go before autofocus";
    EXPECT_EQ(see(like).fStop, 4.0);
    mWorld.registry.remove<scene::CameraLens>(like);
    EXPECT_EQ(see(like).focusDistance, 1.5) << "keys alone";
}

TEST_F(Viewer, TheViewersMotionOverTheFrameIsTheOneItTook) {
    advance(0.0, false);
    const dvec3 before = at(0.0);
    advance(0.1, true);
    EXPECT_GT(glm::distance(at(0.1), before), 0.1);
    EXPECT_NEAR(glm::distance(at(0.0), before), 0.0, 1e-9);
    EXPECT_NEAR(glm::distance(at(0.05), 0.5 * (before + at(0.1))), 0.0, 1e-9);
}

TEST_F(Viewer, APausedCameraKeepsItsWayUntilItIsMoved) {
    advance(0.0, false);
    advance(0.1, true);
    const dvec3 before = at(0.0);
    const dvec3 after = at(0.1);
    for (int i = 0; i < 5; ++i)
        advance(0.1, false, true);
    EXPECT_EQ(at(0.0), before);
    EXPECT_EQ(at(0.1), after);
    advance(0.1, true, true);
    EXPECT_NEAR(glm::distance(at(0.0), after), 0.0, 1e-9);
}

TEST_F(Viewer, AJumpHasNoWay) {
    advance(0.0, false);
    math::Transform there;
    there.translation = {100, 0, 0};
    mCamera->jumpTo(there);
    advance(0.1, false);
    EXPECT_EQ(at(0.0), at(0.1));
    EXPECT_NEAR(at(0.1).x, 100.0, 1e-9);
}

TEST_F(Viewer, TheViewersRecordedPathStaysShort) {
    for (int i = 0; i < 500; ++i)
        advance(0.1 * i, true);
    const auto& path = mWorld.registry.get<scene::PathMotion>(mCamera->entity());
    EXPECT_LE(path.keys.size(), 8u);
    EXPECT_TRUE(validatePath(path));
    EXPECT_LE(path.keys.front().seconds, 49.9 - 0.5);
}

} // namespace
} // namespace shutter::game
