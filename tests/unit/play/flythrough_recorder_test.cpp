// SPDX-License-Identifier: MIT
#include "engine/scene/camera.h"
#include "engine/scene/components.h"
#include "engine/scene/lens.h"
#include "engine/scene/motion.h"
#include "game/play/loop/flythrough_recorder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <numbers>

namespace shutter::game {
namespace {

class Recorder : public testing::Test {
  protected:
    Recorder() {
        std::filesystem::remove_all(mFolder);
        std::filesystem::create_directories(mFolder);
        for (ecs::Entity& camera : mCameras) {
            camera = mWorld.registry.create();
            mWorld.registry.add(camera, scene::Camera{});
            mWorld.registry.add(camera, scene::LocalTransform{});
        }
        mWorld.registry.add(mCameras[0], scene::LinearVelocity{{2.0, 0.0, -1.0}});
        mWorld.registry.add(mCameras[0], scene::AngularVelocity{{0.0, 0.3, 0.0}});
    }

    ~Recorder() override { std::filesystem::remove_all(mFolder); }

    void addFrame(ecs::Entity camera, double seconds) {
        extract::ViewRequest view;
        view.camera = camera;
        view.exposure = scene::computeExposure({}, seconds);
        view.width = 180;
        view.height = 320;
        mRecorder.addFrame(mWorld, view);
    }

    scene::World mWorld;
    ecs::Entity mCameras[2];
    FlythroughRecorder mRecorder;
    std::filesystem::path mFolder =
        std::filesystem::path(testing::TempDir()) /
        (std::string("recorder_") + testing::UnitTest::GetInstance()->current_test_info()->name()
        ); // tests run side by side
};

TEST_F(Recorder, ARecordedFlightRepeatsTheSameMotion) {
    mRecorder.start();
    for (int i = 0; i <= 60; ++i)
        addFrame(mCameras[0], 5.0 + i / 60.0);
    const auto file = mRecorder.finish(mFolder);
    ASSERT_TRUE(file) << file.error().message;
    EXPECT_FALSE(mRecorder.isRecording());
    const auto flight = flythrough::readFlythrough(file.value());
    ASSERT_TRUE(flight) << flight.error().message;
    EXPECT_EQ(flight.value().keys.size(), 11u);
    scene::World other;
    const ecs::Entity flies = flythrough::addFlythroughCamera(other, flight.value());
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
    const auto flight = flythrough::readFlythrough(mRecorder.finish(mFolder).value());
    ASSERT_TRUE(flight) << flight.error().message;
    ASSERT_EQ(flight.value().keys.size(), 2u);
    EXPECT_EQ(flight.value().keys[0].focusDistance, 7.0);
    EXPECT_DOUBLE_EQ(*flight.value().keys[0].fStop, 4.0);
    EXPECT_EQ(flight.value().keys[1].fStop, 1.0e9);
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
        const auto flight = flythrough::readFlythrough(mRecorder.finish(mFolder).value()).value();
        const ecs::Entity flies = flythrough::addFlythroughCamera(mWorld, flight);
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

TEST_F(Recorder, TheFieldOfViewIsThatOfThePicture) {
    mWorld.registry.get<scene::Camera>(mCameras[0]).aspectRatio = 1.125; // twice the picture's
    mRecorder.start();
    addFrame(mCameras[0], 0.0);
    const auto flight = flythrough::readFlythrough(mRecorder.finish(mFolder).value()).value();
    const double yFov = 2.0 * std::atan(2.0 * std::tan(scene::Camera{}.yFov / 2.0));
    EXPECT_NEAR(*flight.keys[0].fieldOfView, yFov * 180.0 / std::numbers::pi, 1e-9);
}

TEST_F(Recorder, ACameraChangeIsACut) {
    mRecorder.start();
    addFrame(mCameras[0], 0.0);
    addFrame(mCameras[0], 0.05);
    addFrame(mCameras[1], 0.07);
    const auto flight = flythrough::readFlythrough(mRecorder.finish(mFolder).value()).value();
    ASSERT_EQ(flight.keys.size(), 3u);
    EXPECT_NEAR(flight.keys[1].seconds, 0.05, 1e-12);
    EXPECT_FALSE(flight.keys[1].cut);
    EXPECT_TRUE(flight.keys[2].cut);
}

TEST_F(Recorder, APauseAddsNothingAndNoTimeIsNoFlight) {
    EXPECT_FALSE(mRecorder.isRecording());
    mRecorder.start();
    EXPECT_FALSE(mRecorder.finish(mFolder));
    mRecorder.start();
    for (int i = 0; i < 5; ++i)
        addFrame(mCameras[0], 1.0);
    const auto first = mRecorder.finish(mFolder);
    ASSERT_TRUE(first) << first.error().message;
    EXPECT_EQ(flythrough::readFlythrough(first.value()).value().keys.size(), 1u);
    mRecorder.start();
    addFrame(mCameras[0], 1.0);
    EXPECT_NE(mRecorder.finish(mFolder).value(), first.value()); // nothing is written over
}

} // namespace
} // namespace shutter::game
