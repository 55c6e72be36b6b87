// SPDX-License-Identifier: MIT
// Which pictures photo mode goes on with.
#include "engine/scene/components.h"
#include "engine/scene/shutter.h"
#include "game/play/loop/photo_mode.h"

#include <gtest/gtest.h>

#include <functional>

namespace shutter::game {
namespace {

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
        const uint32_t before = mode.begin(world, view);
        mode.end();
        return before;
    }

    scene::World world;
    ecs::Entity camera;
    extract::ViewRequest view;
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
