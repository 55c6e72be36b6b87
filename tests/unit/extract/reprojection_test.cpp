// SPDX-License-Identifier: MIT
// Where this frame's surfaces were seen in the raster before it, held against projecting the same
// point anew; and when that raster says nothing.
#include "engine/extract/frame_view.h"
#include "engine/extract/reprojection.h"
#include "engine/scene/history.h"
#include "engine/scene/motion.h"
#include "tests/unit/extract/extraction_fixture.h"

namespace shutter::extract {
namespace {

using math::dvec2;
using math::dvec3;
using math::dvec4;

constexpr double kFrameSeconds = 0.25;

class ReprojectionTest : public Extraction {
  protected:
    ReprojectionTest() {
        setTime(1.0);
        world.registry.add(camera, scene::LinearVelocity{{0.3, -0.1, 0.4}});
        world.registry.add(camera, scene::AngularVelocity{{0.1, 0.2, 0.3}});
        mBox = addBox({0.5, 0.2, -8.0});
    }

    /// Without an exposure: motion vectors would say nothing.
    void setTime(double seconds) {
        scene::CameraShutter shutter;
        shutter.exposureSeconds = 0.0;
        request.exposure = scene::computeExposure(shutter, seconds, kFrameSeconds);
    }

    Reprojection compute(const RasterRecord* last = nullptr) {
        return computeReprojection(world, request, extract(), last);
    }

    /// Reprojection of the frame at 1 s, after one at `seconds`.
    Reprojection computeAfter(double seconds) {
        setTime(seconds);
        request.jitterPx = {0.3, -0.2}; // of no account
        const RasterRecord last = compute().record;
        setTime(1.0);
        request.jitterPx = {-0.1, 0.4};
        return compute(&last);
    }

    /// Picture space of the camera at `seconds`, from the box's own.
    dvec3 project(const dvec3& point, double seconds) const {
        ViewRequest view = request;
        view.jitterPx = dvec2(0.0);
        const dvec4 inView = glm::inverse(scene::worldFromRigid(world, camera, seconds)) *
                             scene::worldFromEntity(world, mBox, seconds) * dvec4(point, 1.0);
        const auto& lens = world.registry.get<scene::Camera>(camera);
        const dvec4 clip = makeProjection(lens, lens.yFov, request) * inView;
        return {
            (dvec2(clip) / clip.w * 0.5 + 0.5) * dvec2(request.width, request.height), -inView.z};
    }

    void expectBoxFound(const Reprojection& found, double lastSeconds) {
        ASSERT_TRUE(found.last.has_value());
        const uint32_t mover = found.last->movers.at(0);
        const auto& rows = found.last->motions.at(mover).instantFromRaster;
        const dvec3 corner(0.9, -0.7, 0.3);
        const dvec3 now = project(corner, 1.0);
        const math::vec4 point(math::vec3(now.x * now.z, now.y * now.z, now.z), 1.0f);
        const math::vec3 before(
            glm::dot(rows[0], point), glm::dot(rows[1], point), glm::dot(rows[2], point)
        );
        const dvec3 expected = project(corner, lastSeconds);
        EXPECT_NEAR(before.x / before.z, expected.x, 2e-3);
        EXPECT_NEAR(before.y / before.z, expected.y, 2e-3);
        EXPECT_NEAR(before.z, expected.z, 1e-4);
    }

    ecs::Entity mBox;
};

TEST_F(ReprojectionTest, AMoverIsFoundWithoutExposureAndWithoutJitter) {
    world.registry.add(mBox, scene::LinearVelocity{{1.0, 0.5, 1.5}});
    world.registry.add(mBox, scene::AngularVelocity{{2.0, 3.0, 1.0}});
    expectBoxFound(computeAfter(0.75), 0.75);
    expectBoxFound(computeAfter(0.5), 0.5); // a frame was left out
}

TEST_F(ReprojectionTest, WhatStandsStillSharesOneMap) {
    const Reprojection found = computeAfter(0.75);
    expectBoxFound(found, 0.75);
    EXPECT_EQ(found.last->movers.at(0), shader::kWorldMover);
    EXPECT_FALSE(found.last->isStill);
}

TEST_F(ReprojectionTest, APausedFrameIsWhereItWas) {
    const RasterRecord last = compute().record;
    request.exposure.frameSeconds = 0.0;
    const Reprojection found = compute(&last);
    ASSERT_TRUE(found.last.has_value());
    EXPECT_TRUE(found.last->isStill);
    EXPECT_EQ(found.ageSeconds, 0.0);
}

TEST_F(ReprojectionTest, WhatWasTeleportedOrHasComeHasNoPlace) {
    setTime(0.75);
    const RasterRecord last = compute().record;
    setTime(1.0);
    math::Transform there;
    there.translation = {-1.0, 0.0, -6.0};
    scene::teleport(world, mBox, there, 0.9);
    const Reprojection found = compute(&last);
    ASSERT_TRUE(found.last.has_value());
    EXPECT_EQ(found.last->movers.at(0), shader::kNoMover);

    const RasterRecord before = found.record;
    addBox({2.0, 0.0, -9.0});
    EXPECT_EQ(compute(&before).last->movers.at(1), shader::kNoMover);
}

TEST_F(ReprojectionTest, ACutAnotherSizeAnotherCameraAndALongTimeEndIt) {
    EXPECT_TRUE(computeAfter(0.75).last.has_value());
    RasterRecord last = compute().record;
    last.seconds = 0.75;
    EXPECT_TRUE(compute(&last).last.has_value());
    RasterRecord other = last;
    other.width += 1;
    EXPECT_FALSE(compute(&other).last.has_value());
    other = last;
    other.camera = mBox;
    EXPECT_FALSE(compute(&other).last.has_value());
    other = last;
    other.seconds = 1.25; // later than the frame
    EXPECT_FALSE(compute(&other).last.has_value());
    other.seconds = 1.0 - 8.0 * kFrameSeconds;
    EXPECT_FALSE(compute(&other).last.has_value());
    scene::cut(world, camera, 0.9);
    EXPECT_FALSE(compute(&last).last.has_value());
}

} // namespace
} // namespace shutter::extract
