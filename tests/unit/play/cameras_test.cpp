// SPDX-License-Identifier: MIT
// The cameras of a player: recorded flights, the viewer's own, and that of photo mode.
#include "engine/scene/auto_focus.h"
#include "engine/scene/camera.h"
#include "engine/scene/components.h"
#include "engine/scene/lens.h"
#include "engine/scene/motion.h"
#include "engine/scene/path.h"
#include "engine/scene/shutter.h"
#include "game/play/loop/flythrough_recorder.h"
#include "game/play/loop/photo_mode.h"
#include "game/play/loop/viewer_camera.h"
#include "tests/support/outcomes.h"
#include "tests/support/temp_folder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <functional>
#include <memory>
#include <numbers>

namespace shutter::game {
namespace {

using app::Key;
using math::dvec3;

class Recorder : public testing::Test {
  protected:
    Recorder() {
        for (ecs::Entity& camera : mCameras) {
            camera = mWorld.registry.create();
            mWorld.registry.add(camera, scene::Camera{});
            mWorld.registry.add(camera, scene::LocalTransform{});
        }
        mWorld.registry.add(mCameras[0], scene::LinearVelocity{{2.0, 0.0, -1.0}});
        mWorld.registry.add(mCameras[0], scene::AngularVelocity{{0.0, 0.3, 0.0}});
    }

    void addFrame(ecs::Entity camera, double seconds) {
        extract::ViewRequest view;
        view.camera = camera;
        view.exposure = scene::computeExposure({}, seconds);
        view.width = 180;
        view.height = 320;
        mRecorder.addFrame(mWorld, view);
    }

    /// What was recorded, as it is read back.
    [[nodiscard]] flythrough::Flythrough finish() {
        const std::filesystem::path file = test::valueOf(mRecorder.finish(mFolder.path()));
        return test::valueOf(flythrough::readFlythrough(file));
    }

    scene::World mWorld;
    ecs::Entity mCameras[2];
    FlythroughRecorder mRecorder;
    test::TempFolder mFolder;
};

TEST_F(Recorder, ARecordedFlightRepeatsTheSameMotion) {
    mRecorder.start();
    for (int i = 0; i <= 60; ++i)
        addFrame(mCameras[0], 5.0 + i / 60.0);
    const flythrough::Flythrough flight = finish();
    EXPECT_FALSE(mRecorder.isRecording());
    EXPECT_EQ(flight.keys.size(), 11u);
    scene::World other;
    const ecs::Entity flies = flythrough::addFlythroughCamera(other, flight);
    for (double t = 0.0; t <= 1.0; t += 0.05) {
        const math::dmat4 own = worldFromEntity(mWorld, mCameras[0], 5.0 + t);
        const math::dmat4 replayed = worldFromEntity(other, flies, t);
        EXPECT_LT(glm::distance(math::dvec3(own[3]), math::dvec3(replayed[3])), 1e-6) << t;
        EXPECT_LT(glm::distance(math::dvec3(own[2]), math::dvec3(replayed[2])), 1e-4) << t;
    }
}

TEST_F(Recorder, TheLensIsRecordedWhereTheFirstCameraHasOne) {
    mWorld.registry.add(
        mCameras[0], scene::CameraLens{.fStop = 2.0, .focusDistance = 7.0, .blurScale = 0.5}
    );
    mRecorder.start();
    addFrame(mCameras[0], 0.0);
    addFrame(mCameras[1], 0.5); // a pinhole
    const flythrough::Flythrough flight = finish();
    ASSERT_EQ(flight.keys.size(), 2u);
    EXPECT_EQ(flight.keys[0].focusDistance, 7.0);
    EXPECT_DOUBLE_EQ(*flight.keys[0].fStop, 4.0);
    EXPECT_EQ(flight.keys[1].fStop, 1.0e9);
}

TEST_F(Recorder, ThePlayedLensIsAsWideAsTheRecordedOne) {
    const scene::CameraLens recorded{
        .fStop = 2.0, .focusDistance = 7.0, .sensorHeight = 0.03, .blurScale = 0.5};
    mWorld.registry.add(mCameras[0], recorded);
    mWorld.registry.get<scene::Camera>(mCameras[0]).aspectRatio = 1.125; // twice the picture's
    mWorld.registry.add(mCameras[1], scene::CameraLens{});
    const auto play = [&] {
        mRecorder.start();
        addFrame(mCameras[0], 0.0);
        const ecs::Entity flies = flythrough::addFlythroughCamera(mWorld, finish());
        mWorld.cameras.pop_back();
        const scene::CameraLens played = scene::lensAt(mWorld, flies, 0.0);
        EXPECT_DOUBLE_EQ(played.focusDistance, 7.0);
        return scene::computeLensRadius(played, scene::yFovAt(mWorld, flies, 0.0));
    };
    const double radius = scene::computeLensRadius(recorded, scene::Camera{}.yFov);
    EXPECT_NEAR(play(), radius, 1e-9 * radius) << "a world without cameras";
    mWorld.cameras = {mCameras[0]};
    EXPECT_NEAR(play(), radius, 1e-9 * radius) << "the first one";
    mWorld.registry.add(mCameras[0], scene::LensOverride{.fStop = 4.0, .blurScale = 2.0});
    EXPECT_NEAR(play(), radius, 1e-9 * radius) << "seen through a viewer's lens";
    mWorld.registry.remove<scene::LensOverride>(mCameras[0]);
    mWorld.cameras = {mCameras[1], mCameras[0]};
    EXPECT_NEAR(play(), radius, 1e-9 * radius) << "another one";
    mWorld.registry.get<scene::CameraLens>(mCameras[1]).blurScale = 0.0;
    EXPECT_EQ(play(), 0.0) << "no F-number opens this one";
}

TEST_F(Recorder, TheFieldOfViewIsThatOfThePictureAndACameraChangeIsACut) {
    mWorld.registry.get<scene::Camera>(mCameras[0]).aspectRatio = 1.125; // twice the picture's
    mRecorder.start();
    addFrame(mCameras[0], 0.0);
    const flythrough::Flythrough flight = finish();
    const double yFov = 2.0 * std::atan(2.0 * std::tan(scene::Camera{}.yFov / 2.0));
    EXPECT_NEAR(*flight.keys[0].fieldOfView, yFov * 180.0 / std::numbers::pi, 1e-9);
    mRecorder.start();
    addFrame(mCameras[0], 0.0);
    addFrame(mCameras[0], 0.05);
    addFrame(mCameras[1], 0.07);
    const flythrough::Flythrough changed = finish();
    ASSERT_EQ(changed.keys.size(), 3u);
    EXPECT_NEAR(changed.keys[1].seconds, 0.05, 1e-12);
    EXPECT_FALSE(changed.keys[1].cut);
    EXPECT_TRUE(changed.keys[2].cut);
}

TEST_F(Recorder, APauseAddsNothingAndNoTimeIsNoFlight) {
    EXPECT_FALSE(mRecorder.isRecording());
    mRecorder.start();
    EXPECT_FALSE(mRecorder.finish(mFolder.path()));
    mRecorder.start();
    for (int i = 0; i < 5; ++i)
        addFrame(mCameras[0], 1.0);
    EXPECT_EQ(finish().keys.size(), 1u);
    mRecorder.start();
    addFrame(mCameras[0], 1.0);
    EXPECT_EQ(finish().keys.size(), 1u);
    EXPECT_EQ(test::countFiles(mFolder.path()), 2u) << "nothing is written over";
}

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

TEST_F(Viewer, TheViewerStartsAtTheOtherCameraAndAJumpHasNoWay) {
    advance(0.0, false);
    EXPECT_NEAR(glm::distance(at(0.0), dvec3(0, 1, 5)), 0.0, 1e-9);
    EXPECT_EQ(at(-1.0), at(0.0));
    math::Transform there;
    there.translation = {100, 0, 0};
    mCamera->jumpTo(there);
    advance(0.1, false);
    EXPECT_EQ(at(0.0), at(0.1));
    EXPECT_NEAR(at(0.1).x, 100.0, 1e-9);
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

TEST_F(Viewer, TheViewersRecordedPathStaysShort) {
    for (int i = 0; i < 500; ++i)
        advance(0.1 * i, true);
    const auto& path = mWorld.registry.get<scene::PathMotion>(mCamera->entity());
    EXPECT_LE(path.keys.size(), 8u);
    EXPECT_TRUE(validatePath(path));
    EXPECT_LE(path.keys.front().seconds, 49.9 - 0.5);
}

class PhotoFlight : public testing::Test {
  protected:
    PhotoFlight() {
        stage = world.registry.create();
        world.registry.add(stage, scene::Camera{});
        math::Transform placement;
        placement.translation = {1, 2, 3};
        placement.rotation = glm::angleAxis(0.4, glm::normalize(dvec3(0.3, 1.0, 0.2))); // it rolls
        world.registry.add(stage, scene::LocalTransform{placement});
        world.registry.add(stage, scene::LinearVelocity{{0, 0, -20}});
    }

    void fly(Key key, double seconds) {
        app::InputState input;
        input.down.set(static_cast<size_t>(key));
        camera.advance(world, input, seconds, 500.0);
    }

    [[nodiscard]] math::dmat4 at(ecs::Entity entity, double seconds) const {
        return worldFromEntity(world, entity, seconds);
    }

    void expectNear(const math::dmat4& a, const math::dmat4& b) const {
        for (int i = 0; i < 4; ++i)
            EXPECT_LT(glm::distance(a[i], b[i]), 1e-9) << "column " << i;
    }

    scene::World world;
    ecs::Entity stage;
    PhotoCamera camera;
    static constexpr double kNow = 0.5;
};

TEST_F(PhotoFlight, AnUnmovedPhotoCameraIsTheStagesCameraWithRoll) {
    camera.take(world, stage, kNow);
    camera.advance(world, {}, 0.1, 500.0);
    for (const double seconds : {kNow, kNow - 0.02})
        expectNear(at(camera.entity(), seconds), at(stage, seconds));
}

TEST_F(PhotoFlight, ItHasTheLensOfTheCameraItHangsOnAndWhatFocusesIt) {
    world.registry.add(stage, scene::CameraLens{.fStop = 2.0, .focusDistance = 7.0});
    world.registry.add(
        stage,
        scene::FocusMotion{
            {{0.0, 1.0, {}, false}, {1.0, 3.0, {}, false}}, scene::PathInterpolation::Linear}
    );
    camera.take(world, stage, kNow);
    for (const double seconds : {kNow - 0.1, kNow}) {
        const scene::CameraLens own = scene::lensAt(world, stage, seconds);
        const scene::CameraLens photo = scene::lensAt(world, camera.entity(), seconds);
        EXPECT_EQ(photo.fStop, 2.0);
        EXPECT_EQ(photo.focusDistance, own.focusDistance) << seconds;
    }
    camera.putBack(world);
    world.registry.remove<scene::FocusMotion>(stage);
    const ecs::Entity target = world.registry.create();
    world.registry.add(target, scene::LocalTransform{{.translation = {0, 0, -50}}});
    world.registry.add(stage, scene::AutoFocus{target});
    scene::advanceAutoFocus(world, kNow);
    const double focused = scene::lensAt(world, stage, kNow).focusDistance;
    EXPECT_GT(focused, 10.0);
    camera.take(world, stage, kNow);
    EXPECT_EQ(scene::lensAt(world, camera.entity(), kNow).focusDistance, focused);
}

TEST_F(PhotoFlight, ItHasTheViewersLensAtOnce) {
    world.registry.add(stage, scene::LensOverride{.fStop = 2.8, .focusDistance = 3.0});
    camera.take(world, stage, kNow);
    EXPECT_TRUE(scene::hasLens(world, camera.entity()));
    EXPECT_EQ(scene::lensAt(world, camera.entity(), kNow).focusDistance, 3.0);
}

TEST_F(PhotoFlight, ThePhotoCameraFliesAheadAndKeepsTheStageCamerasBlur) {
    camera.take(world, stage, kNow);
    const dvec3 ahead = -dvec3(at(stage, kNow)[2]);
    fly(Key::W, 0.5);
    const dvec3 moved = dvec3(at(camera.entity(), kNow)[3]) - dvec3(at(stage, kNow)[3]);
    EXPECT_GT(glm::dot(moved, ahead), 0.5);
    // It rides along: over an exposure it takes the way of the stage's camera.
    const dvec3 way = dvec3(at(camera.entity(), kNow)[3] - at(camera.entity(), kNow - 0.02)[3]);
    EXPECT_NEAR(way.z, -0.4, 1e-9);
    EXPECT_NEAR(glm::length(way), 0.4, 1e-9);
}

TEST_F(PhotoFlight, ScaleOfTheStagesCameraIsNotItsOwn) {
    const auto view = [&](ecs::Entity entity) { return worldFromRigid(world, entity, kNow); };
    const ecs::Entity above = world.registry.create();
    world.registry.add(stage, scene::Parent{above});
    for (const dvec3& scale : {dvec3(1, 3, 0.5), dvec3(-1, 1, 1), dvec3(10, 10, 10), dvec3(0)}) {
        world.registry.add(above, scene::LocalTransform{{{1, 0, 0}, {1, 0, 0, 0}, scale}});
        world.registry.get<scene::LocalTransform>(stage).transform.scale = {1, -2, 1};
        camera.take(world, stage, kNow);
        camera.advance(world, {}, 0.1, 500.0);
        expectNear(view(camera.entity()), view(stage));
        fly(Key::W, 0.5);
        const dvec3 way(view(camera.entity())[3] - view(stage)[3]);
        EXPECT_NEAR(glm::length(way), 2.0, 1e-9) << "4 m/s";
        EXPECT_NEAR(glm::dot(way, dvec3(view(stage)[2])), -2.0, 1e-9);
        camera.putBack(world);
    }
}

TEST_F(PhotoFlight, ThePhotoCameraIsMadeOnceAndLeavesNothingBehind) {
    camera.advance(world, {}, 0.1, 500.0); // not out: nothing to move
    const size_t before = world.registry.aliveCount();
    camera.take(world, stage, kNow);
    const ecs::Entity first = camera.entity();
    fly(Key::W, 0.5);
    camera.take(world, stage, kNow);
    EXPECT_EQ(camera.entity(), first);
    EXPECT_EQ(world.registry.aliveCount(), before + 1);
    camera.putBack(world);
    camera.putBack(world);
    EXPECT_FALSE(camera.isOut());
    EXPECT_EQ(world.registry.aliveCount(), before);
}

class Photo : public ::testing::Test {
  protected:
    Photo() {
        camera = world.registry.create();
        world.registry.add(camera, scene::Camera{});
        world.registry.add(camera, scene::LocalTransform{});
        view.camera = camera;
        view.width = 64;
        view.height = 48;
        view.exposure = scene::computeExposure({}, 1.0);
        mode.turn(true);
    }

    uint32_t draw() {
        const uint32_t before = mode.begin(world, view, features);
        mode.end();
        return before;
    }

    scene::World world;
    ecs::Entity camera;
    extract::ViewRequest view;
    FeatureSettings features;
    PhotoMode mode;
};

TEST_F(Photo, EachFrameOfTheSamePictureAddsARayUntilThereAreEnough) {
    for (uint32_t i = 0; i < PhotoMode::kMaxRays; ++i) {
        EXPECT_EQ(mode.raysToAdd(), 1u);
        ASSERT_EQ(draw(), i);
    }
    for (int i = 0; i < 3; ++i) {
        EXPECT_EQ(mode.raysToAdd(), 0u);
        EXPECT_EQ(draw(), PhotoMode::kMaxRays);
    }
    EXPECT_EQ(mode.rays(), PhotoMode::kMaxRays);
}

TEST_F(Photo, AChangedPictureRestartsThePhoto) {
    const std::function<void()> changes[] = {
        [&] { view.width = 65; },
        [&] { view.height = 49; },
        [&] { view.background.x += 0.5f; },
        [&] { view.ambient.y += 0.5f; },
        [&] { features.shadows.mode = shadows::ShadowMode::Sharp; },
        [&] { view.exposure = scene::computeExposure({}, 2.0); },
        [&] { view.exposure.shutter.objectScale = 0.5; },
        [&] { view.exposure.shutter.response.shape = scene::ResponseShape::Triangle; },
        [&] {
            view.exposure.shutter.response.samples = {1.0, 2.0};
        },
        [&] { world.registry.get<scene::LocalTransform>(camera).transform.translation.x += 1.0; },
        [&] { world.registry.add(camera, scene::CameraLens{.fStop = 2.0}); },
        [&] { world.registry.add(camera, scene::LensOverride{.focusDistance = 3.0}); },
        [&] { world.registry.add(camera, scene::LensOverride{.blurScale = 0.0}); },
    };
    for (const auto& change : changes) {
        draw();
        EXPECT_GT(draw(), 0u);
        change();
        EXPECT_EQ(draw(), 0u);
    }
}

TEST_F(Photo, APhotoTracesTheWholeWindowAndKeepsTheSettings) {
    PlaySettings settings;
    settings.split = true;
    settings.view = "motion";
    const PlaySettings chosen = mode.choose(settings);
    EXPECT_EQ(chosen.method, "truth");
    EXPECT_FALSE(chosen.split);
    EXPECT_TRUE(chosen.view.empty());
    EXPECT_EQ(settings.method, PlaySettings().method);
    draw();
    mode.turn(false);
    EXPECT_FALSE(mode.rays());
    mode.turn(true);
    EXPECT_EQ(mode.rays(), 0u);
}

TEST_F(Photo, ThePictureStaysTheMethodsWithoutRays) {
    PlaySettings settings;
    settings.method = "gather";
    settings.split = true;
    mode.turn(true, false);
    EXPECT_TRUE(mode.isOn());
    EXPECT_FALSE(mode.isTracing());
    EXPECT_FALSE(mode.rays());
    EXPECT_EQ(mode.choose(settings).method, "gather");
    EXPECT_FALSE(mode.choose(settings).split);
    // Depth of field is seen all the same, through enough places of the lens.
    EXPECT_EQ(mode.choose(settings, true).method, "accumulate");
    EXPECT_EQ(mode.choose(settings, true).instants, PhotoMode::kLensPictures);
    settings.instants = 200;
    EXPECT_EQ(mode.choose(settings, true).instants, 200u);
    mode.turn(true);
    EXPECT_EQ(mode.choose(settings, true).method, "truth");
}

} // namespace
} // namespace shutter::game
