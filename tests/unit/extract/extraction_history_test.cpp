// SPDX-License-Identifier: MIT
// What has no past, is hidden, or is scaled by an artist, in the entity table and for rays.
#include "engine/extract/frame_view.h"
#include "engine/extract/timed_tables.h"
#include "engine/scene/history.h"
#include "tests/unit/extract/extraction_fixture.h"

namespace shutter::extract {
namespace {

class ExtractionHistory : public Extraction {
  protected:
    ExtractionHistory() {
        scene::CameraShutter shutter;
        shutter.exposureSeconds = 1.0;
        request.exposure = scene::computeExposure(shutter, 1.0, 1.0);
    }

    ecs::Entity addMover() {
        const ecs::Entity mover = addBox({0.0, 0.0, -10.0});
        world.registry.add(mover, scene::LinearVelocity{{1.0, 0.0, 0.0}});
        return mover;
    }

    TimedTables computeTables(ExtractedFrame& frame) const {
        auto tables = computeTimedTables(world, layout, request, frame);
        EXPECT_TRUE(tables.ok());
        return std::move(tables).value();
    }

    void expectStill(const ExtractedFrame& extracted, size_t row) const {
        EXPECT_EQ(extracted.entities.at(row).motion, shader::kNoMotion);
        ExtractedFrame frame = extracted;
        EXPECT_EQ(computeTables(frame).rows.at(row).keys.size(), 1u);
    }
};

TEST_F(ExtractionHistory, WhatAppearedStandsStillAndNothingMoves) {
    const ecs::Entity mover = addMover();
    EXPECT_TRUE(extract().moves);
    scene::appear(world, mover, 1.0);
    const ExtractedFrame frame = extract();
    EXPECT_FALSE(frame.moves);
    expectStill(frame, 0);
}

TEST_F(ExtractionHistory, RaysMeetWhatAppearsFromThenOnAndWhatIsHiddenUntilThen) {
    const ecs::Entity mover = addMover();
    scene::appear(world, mover, 0.7);
    ExtractedFrame frame = extract();
    EXPECT_FALSE(frame.moves) << "a raster shows it all the time or never";
    auto keys = computeTables(frame).rows.at(0).keys;
    EXPECT_FALSE(isDrawable(interpolateKeys(keys, 0.69)));
    EXPECT_EQ(interpolateKeys(keys, 0.71), interpolateKeys(keys, 1.0)) << "it stands still";
    EXPECT_TRUE(isDrawable(interpolateKeys(keys, 1.0)));
    world.registry.remove<scene::Appeared>(mover);
    scene::hide(world, mover, 0.4);
    frame = extract();
    EXPECT_TRUE(frame.entities.empty()) << "at the raster instant it is hidden";
    keys = computeTables(frame).rows.at(0).keys;
    EXPECT_TRUE(isDrawable(interpolateKeys(keys, 0.39)));
    EXPECT_NEAR(interpolateKeys(keys, 0.39)[3].x, 0.39, 1e-3) << "it moves until then";
    EXPECT_FALSE(isDrawable(interpolateKeys(keys, 0.41)));
}

TEST_F(ExtractionHistory, ACutLeavesNothingMoving) {
    addMover();
    world.registry.add(camera, scene::LinearVelocity{{0.3, 0.0, 0.0}});
    EXPECT_TRUE(extract().moves);
    scene::cut(world, camera, 0.7);
    ExtractedFrame frame = extract();
    EXPECT_FALSE(frame.moves);
    EXPECT_EQ(frame.constants.clipFromEyeOpen, frame.constants.clipFromEyeClose);
    expectStill(frame, 0);
    EXPECT_EQ(computeTables(frame).camera.keys.size(), 1u);
}

TEST_F(ExtractionHistory, AllScalesZeroLeaveNothingMoving) {
    addMover();
    world.registry.add(camera, scene::LinearVelocity{{0.3, 0.0, 0.0}});
    scene::CameraShutter& shutter = request.exposure.shutter;
    shutter.cameraRotationScale = shutter.cameraTranslationScale = shutter.objectScale = 0.0;
    const ExtractedFrame frame = extract();
    EXPECT_FALSE(frame.moves);
    expectStill(frame, 0);
}

TEST_F(ExtractionHistory, AnExcludedMoverStaysOnTheScreenAndMovesForRays) {
    const ecs::Entity mover = addMover();
    world.registry.add(camera, scene::LinearVelocity{{0.3, 0.0, 0.0}});
    world.registry.add(mover, scene::MotionBlur{.exclude = true});
    ExtractedFrame frame = extract();
    EXPECT_TRUE(frame.moves) << "the camera does";
    const shader::EntityMotion motion = motionOf(frame, 0);
    const math::vec3 open = project(motion.clipFromObjectOpen, {1, 1, 1});
    const math::vec3 close = project(motion.clipFromObjectClose, {1, 1, 1});
    EXPECT_NEAR(open.x, close.x, 1e-6f);
    EXPECT_NEAR(open.y, close.y, 1e-6f);
    EXPECT_GT(computeTables(frame).rows.at(0).keys.size(), 1u);
}

TEST_F(ExtractionHistory, WhatIsHiddenHasNoRowNorLight) {
    const ecs::Entity mover = addMover();
    const ecs::Entity other = addMover();
    const ecs::Entity lamp = world.registry.create();
    world.registry.add(lamp, scene::Light{});
    world.registry.add(lamp, scene::Parent{mover});
    scene::hide(world, mover);
    ExtractedFrame frame = extract();
    ASSERT_EQ(frame.entityHandles, std::vector<ecs::Entity>{other});
    EXPECT_TRUE(frame.lights.empty());
    EXPECT_EQ(computeTables(frame).rows.size(), 1u) << "rays meet it no more than the picture";
    scene::show(world, mover, 0.7);
    EXPECT_EQ(extract().entities.size(), 2u);
    EXPECT_EQ(extract().lights.size(), 1u);
}

TEST_F(ExtractionHistory, WhatWasDespawnedLeavesNothing) {
    const ecs::Entity mover = addMover();
    scene::despawn(world, mover);
    ExtractedFrame frame = extract();
    EXPECT_TRUE(frame.entities.empty());
    EXPECT_FALSE(frame.moves);
    EXPECT_TRUE(computeTables(frame).rows.empty());
}

} // namespace
} // namespace shutter::extract
