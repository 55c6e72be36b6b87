// SPDX-License-Identifier: MIT
#include "engine/extract/demand.h"
#include "tests/unit/extract/extraction_fixture.h"

#include <limits>

namespace shutter::extract {

namespace {

/// Boxes that fill [-1, 1]^3 before a camera at the origin that looks down -Z.
class Backdrop : public Extraction {
  protected:
    ecs::Entity addMover(const math::dvec3& position) {
        const ecs::Entity entity = addBox(position);
        world.registry.add(entity, scene::LinearVelocity{{0.5, 0.0, 0.0}});
        return entity;
    }

    core::Decision decide() { return decideReveal(extract(), layout); }
};

} // namespace

TEST_F(Backdrop, NothingButSkyLiesBehindASingleMover) {
    addMover({0.0, 0.0, -10.0});
    const core::Decision decision = decide();
    EXPECT_FALSE(decision.run);
    EXPECT_EQ(decision.reason, "nothing but sky lies behind what moves");
}

TEST_F(Backdrop, WhatStandsBehindTheMoverMayComeIntoSight) {
    addMover({0.0, 0.0, -10.0});
    addBox({0.0, 0.0, -20.0});
    EXPECT_TRUE(decide().run);
}

TEST_F(Backdrop, WhatStandsBesideOrBeforeItMayNot) {
    addMover({0.0, 0.0, -10.0});
    addBox({0.0, 0.0, -4.0});   // before it, although it hides part of it
    addBox({12.0, 0.0, -20.0}); // in the picture, to the right of it
    EXPECT_FALSE(decide().run);
}

TEST_F(Backdrop, WhatAdjoinsItOnTheScreenCountsAsBehind) {
    // Their boxes touch: the mover's right side at 1/9 of the distance, the other's left one at
    // 2/18.
    addMover({0.0, 0.0, -10.0});
    addBox({3.302, 0.0, -19.0});
    EXPECT_TRUE(decide().run);
}

TEST_F(Backdrop, WhatIsNoNumberMayBeAnywhere) {
    addMover({0.0, 0.0, -10.0});
    addBox({12.0, 0.0, -20.0});
    ExtractedFrame frame = extract();
    ASSERT_FALSE(decideReveal(frame, layout).run);
    frame.entities[1].eyeFromObject[2][3] = std::numeric_limits<float>::quiet_NaN();
    EXPECT_TRUE(decideReveal(frame, layout).run);
}

TEST_F(Backdrop, AMoverMayRevealAnotherOne) {
    addMover({0.0, 0.0, -10.0});
    addMover({0.5, 0.0, -14.0});
    EXPECT_TRUE(decide().run);
}

TEST_F(Backdrop, BoxesThatReachIntoEachOtherCountAsBehind) {
    addMover({0.0, 0.0, -10.0});
    addBox({0.0, 0.0, -9.0});
    EXPECT_TRUE(decide().run);
}

TEST_F(Backdrop, WhatCrossesTheNearPlaneIsTakenToFillThePicture) {
    addMover({0.0, 0.0, -0.5});
    addBox({14.0, 0.0, -20.0});
    EXPECT_TRUE(decide().run);
}

TEST_F(Backdrop, BlendedSurfacesAlwaysCount) {
    addMover({0.0, 0.0, -10.0});
    const uint32_t glass = addMesh(scene::AlphaMode::Blend, 1);
    addBox(math::dvec3(12.0, 0.0, -20.0), glass);
    EXPECT_TRUE(decide().run);
}

TEST_F(Backdrop, WhatDoesNotMoveRevealsNothing) {
    addBox({0.0, 0.0, -10.0});
    addBox({0.0, 0.0, -20.0});
    EXPECT_FALSE(decide().run);
}

TEST_F(Backdrop, ACameraThatMovesMakesEverythingAMover) {
    addBox({0.0, 0.0, -10.0});
    world.registry.add(camera, scene::LinearVelocity{{0.5, 0.0, 0.0}});
    EXPECT_FALSE(decide().run);
    addBox({0.0, 0.0, -20.0});
    EXPECT_TRUE(decide().run);
}

TEST_F(Backdrop, ManyMoversAreNotLookedAtOneByOne) {
    // In a fan: none lies behind another.
    for (int i = 0; i < 65; ++i)
        addMover({-8.0 + 0.25 * i, i % 2 == 0 ? 3.0 : -3.0, -900.0 - 10.0 * i});
    EXPECT_TRUE(decide().run);
}

} // namespace shutter::extract
