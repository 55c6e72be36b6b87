// SPDX-License-Identifier: MIT
#include "engine/extract/motion_parts.h"
#include "tests/unit/extract/extraction_fixture.h"

#include <cmath>
#include <numbers>

namespace shutter::extract {

namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;

class MotionPartsTest : public Extraction {
  protected:
    MotionParts plan() { return planMotionParts(world, layout, extract(), request); }
};

} // namespace

TEST_F(MotionPartsTest, NothingThatMovesTakesNoPart) {
    addBox({0.0, 0.0, -5.0});
    EXPECT_EQ(plan().count, 0u);
}

TEST_F(MotionPartsTest, AStraightWayIsOnePart) {
    world.registry.add(addBox({0.0, 0.0, -5.0}), scene::LinearVelocity{{1.0, 0.5, 0.0}});
    EXPECT_EQ(plan().count, 1u);
}

TEST_F(MotionPartsTest, AWholeTurnIsNotTakenForRest) {
    // At open, raster and close the box is where it was.
    request.exposure = {0.0, 1.0, 1.0, 1.0};
    world.registry.add(addBox({0.0, 0.0, -5.0}), scene::AngularVelocity{{0.0, kTurn, 0.0}});
    const uint32_t parts = plan().count;
    EXPECT_GE(parts, 4u); // a quarter's chord is 0.9003 of its arc
    EXPECT_LE(parts, 8u);
}

TEST_F(MotionPartsTest, MoreTurnsTakeMoreParts) {
    world.registry.add(addBox({0.0, 0.0, -5.0}), scene::AngularVelocity{{0.0, 4 * kTurn, 0.0}});
    EXPECT_GE(plan().count, 16u);
    EXPECT_LE(plan().count, kMaxMotionParts);
}

TEST_F(MotionPartsTest, ACameraThatTurnsOnceIsNotAtRestEither) {
    world.registry.add(camera, scene::AngularVelocity{{0.0, kTurn, 0.0}});
    EXPECT_GE(plan().count, 4u);
}

TEST_F(MotionPartsTest, AnExposureWithoutLengthMovesNothing) {
    request.exposure = {1.0, 1.0, 1.0, 1.0};
    world.registry.add(addBox({0.0, 0.0, -5.0}), scene::LinearVelocity{{1.0, 0.0, 0.0}});
    EXPECT_EQ(plan().count, 0u);
}

TEST_F(MotionPartsTest, ACasterBesideThePictureCountsWithShadowsOnly) {
    // Behind the camera, by 5 m; at the raster instant it has moved by 1 m.
    world.registry.add(addBox({0.0, 0.0, 5.0}), scene::LinearVelocity{{1.0, 0.0, 0.0}});
    EXPECT_EQ(plan().casterPx, 0.0);
    request.shadows.mode = ShadowMode::Sharp;
    const double pixel = double{extract().constants.pixelFootprint.x} * std::hypot(5.0, 1.0);
    EXPECT_NEAR(plan().casterPx, 1.0 / pixel, 1.0e-6 / pixel);
    request.unlit = true;
    EXPECT_EQ(plan().casterPx, 0.0);
}

TEST_F(MotionPartsTest, AMovingLightIsToldUnlessThePictureIsUnlit) {
    const ecs::Entity light = world.registry.create();
    world.registry.add(light, scene::LocalTransform{});
    world.registry.add(light, scene::Light{});
    EXPECT_FALSE(plan().movesLight);
    world.registry.add(light, scene::LinearVelocity{{1.0, 0.0, 0.0}});
    EXPECT_TRUE(plan().movesLight);
    request.unlit = true;
    EXPECT_FALSE(plan().movesLight);
}

} // namespace shutter::extract
