// SPDX-License-Identifier: MIT
// Whether a lens spreads anything that the picture may show.
#include "engine/extract/defocus.h"
#include "engine/scene/lens.h"
#include "tests/unit/extract/extraction_fixture.h"

#include <cmath>

namespace shutter::extract {
namespace {

class DefocusTest : public Extraction {
  protected:
    /// Through a lens focused at 10 m that spreads what is infinitely far away over `farPx`.
    bool isDefocusedBy(double farPx) {
        const auto& pinhole = world.registry.get<scene::Camera>(camera);
        const double pixelsPerUnit = request.height / (2.0 * std::tan(pinhole.yFov / 2.0));
        const double radius = farPx * 10.0 / (2.0 * pixelsPerUnit);
        scene::CameraLens lens{.fStop = 1.0, .focusDistance = 10.0};
        lens.fStop = scene::computeLensRadius(lens, pinhole.yFov) / radius;
        world.registry.add(camera, lens);
        request.usesLens = true;
        const bool isDefocused = extract::isDefocused(world, request, motion(), extract(), layout);
        world.registry.remove<scene::CameraLens>(camera);
        return isDefocused;
    }
};

TEST_F(DefocusTest, GoesByWhatIsInfinitelyFarAway) {
    EXPECT_FALSE(isDefocusedBy(0.49));
    EXPECT_TRUE(isDefocusedBy(0.51));
}

TEST_F(DefocusTest, GoesByTheNearestThatIsInSight) {
    // Its front is at 4 m, spread over 1.5 times what is far away.
    addBox({0.0, 0.0, -5.0});
    EXPECT_FALSE(isDefocusedBy(0.33));
    EXPECT_TRUE(isDefocusedBy(0.34));
    addBox({0.0, 0.0, 2.0});  // behind the camera
    addBox({9.0, 0.0, -2.0}); // beside the picture
    EXPECT_FALSE(isDefocusedBy(0.33));
}

TEST_F(DefocusTest, AFloorCountsFromWhereThePictureShowsIt) {
    // 1 m below the camera, and under it.
    math::Transform floor;
    floor.translation = {0.0, -1.01, 0.0};
    floor.scale = {50.0, 0.01, 50.0};
    addBox(floor);
    const double nearest = 1.0 / std::tan(scene::Camera{}.yFov / 2.0);
    const double share = 10.0 / nearest - 1.0;
    EXPECT_FALSE(isDefocusedBy(0.49 / share));
    EXPECT_TRUE(isDefocusedBy(0.51 / share));
}

TEST_F(DefocusTest, WhatComesNearWithinTheExposureCounts) {
    addMover({0.0, 0.0, -5.0}, {0.0, 0.0, 2.0}); // the raster is at its end
    EXPECT_FALSE(isDefocusedBy(0.1));
    EXPECT_TRUE(isDefocusedBy(0.3));
}

TEST_F(DefocusTest, WhatRushesByWithinTheExposureCounts) {
    // In sight when a quarter of the exposure is over, its front at 1.5 m.
    const ecs::Entity box = addBox({10.0, 0.0, -2.5});
    EXPECT_FALSE(isDefocusedBy(0.2));
    world.registry.add(box, scene::LinearVelocity{{-40.0, 0.0, 0.0}});
    EXPECT_TRUE(isDefocusedBy(0.2));
}

TEST_F(DefocusTest, WhatDeformsCountsWithWhereItIsAtTheExposuresEnds) {
    // It reaches 2 m further to the camera when the shutter opens; the raster is at the end.
    scene::Primitive point;
    point.positions = {{0.0f, 0.0f, 1.0f}};
    point.morphTargets.emplace_back().positions = {{0.0f, 0.0f, 2.0f}};
    layout.geometries[0].vertexCount = 1;
    layout.reaches.push_back(scene::computePoseReach({&point, 1}));
    const ecs::Entity box = addMorphed({0.0, 0.0, -5.0}, {0.0f, 1.0f}, {1.0f, 0.0f});
    const auto weights = world.registry.get<scene::MorphWeights>(box);
    world.registry.remove<scene::MorphWeights>(box);
    EXPECT_FALSE(isDefocusedBy(0.2));
    world.registry.add(box, weights);
    EXPECT_TRUE(isDefocusedBy(0.2));
    EXPECT_FALSE(isDefocusedBy(0.1));
}

TEST_F(DefocusTest, InBoundsThatHoldTheCameraAnythingMayBeNearAndAPinholeSpreadsNothing) {
    addBox({0.0, 0.0, 0.5});
    for (const bool usesLens : {false, true}) {
        request.usesLens = usesLens;
        EXPECT_FALSE(isDefocused(world, request, motion(), extract(), layout));
    }
    EXPECT_TRUE(isDefocusedBy(1e-3));
}

} // namespace
} // namespace shutter::extract
