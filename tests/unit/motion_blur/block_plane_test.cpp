// SPDX-License-Identifier: MIT
#include "engine/math/layer_tables.h"
#include "shaders/motion_blur/block_plane.glsl"

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

namespace shutter {
namespace {

using math::dmat4;
using math::dvec2;
using math::dvec3;
using math::dvec4;
using shader::BlockPlane;
using shader::PlaneMap;

constexpr math::uvec2 kSizePx{640, 360};

/// From the raster's picture space to an instant's, and planes in it.
class PlanePicture {
  public:
    PlanePicture(bool perspective, const dmat4& viewNowFromThen) : mPerspective(perspective) {
        dmat4 clip(1.0);
        if (perspective) {
            clip = glm::perspective(0.9, 640.0 / 360.0, 0.1, 100.0);
            clip[1][1] *= -1.0;
        } else {
            clip = glm::ortho(-4.0, 4.0, 2.25, -2.25, 0.1, 100.0);
        }
        const dmat4 picture = math::pictureFromView(clip, kSizePx, dvec2(0.0));
        mInstantFromRaster = picture * viewNowFromThen * glm::inverse(picture);
        mMotion = math::makeInstantMotion(mInstantFromRaster);
    }

    [[nodiscard]] PlaneMap map(const BlockPlane& plane, math::vec2 centre, math::vec2 x) const {
        return shader::mapPlane(mMotion.instantFromRaster, plane, centre, x, mPerspective);
    }

    /// Where the raster's place, on a surface with that `along`, is seen at the instant.
    [[nodiscard]] dvec2 see(const dvec2& place, double along) const {
        const double depth = mPerspective ? 1.0 / along : along;
        const double q = mPerspective ? depth : 1.0;
        const dvec4 seen = mInstantFromRaster * dvec4(place * q, depth, 1.0);
        return dvec2(seen) / (mPerspective ? seen.z : 1.0);
    }

  private:
    bool mPerspective;
    dmat4 mInstantFromRaster{1.0};
    shader::InstantMotion mMotion;
};

dmat4 makeMove() {
    return glm::translate(dmat4(1.0), dvec3(0.05, -0.02, 0.1)) *
           glm::rotate(dmat4(1.0), 0.01, glm::normalize(dvec3(0.3, 1.0, 0.5)));
}

constexpr math::vec2 kCentre{412.0f, 100.0f};
constexpr math::vec2 kTarget{404.0f, 108.0f};

/// Steep, as a floor is.
BlockPlane makePlane(bool perspective) {
    if (perspective)
        return {0, 0, 0.25f, math::vec2(0.001f, 0.004f), 0.0f};
    return {0, 0, 4.0f, math::vec2(0.01f, 0.05f), 0.0f};
}

double alongAt(const BlockPlane& plane, const dvec2& place) {
    return plane.along + glm::dot(dvec2(plane.slope), place - dvec2(kCentre));
}

class BlockPlaneMap : public testing::TestWithParam<bool> {};

TEST_P(BlockPlaneMap, TheMapAgreesWithTheProjectionOfThePlane) {
    const PlanePicture picture(GetParam(), makeMove());
    const BlockPlane plane = makePlane(GetParam());
    const PlaneMap map = picture.map(plane, kCentre, kTarget);
    ASSERT_TRUE(map.isAffine);
    for (const dvec2 offset : {dvec2(0), dvec2(4, -4), dvec2(-4, 4), dvec2(3.5, 3.5)}) {
        const dvec2 place =
            dvec2(map.place) + dvec2(map.perX) * offset.x + dvec2(map.perY) * offset.y;
        const dvec2 seen = picture.see(place, alongAt(plane, place));
        EXPECT_NEAR(seen.x, kTarget.x + offset.x, 0.02);
        EXPECT_NEAR(seen.y, kTarget.y + offset.y, 0.02);
    }
}

TEST_P(BlockPlaneMap, TheMapBoundsTheErrorOfADeviationFromThePlane) {
    const PlanePicture picture(GetParam(), makeMove());
    BlockPlane plane = makePlane(GetParam());
    const PlaneMap map = picture.map(plane, kCentre, kTarget);
    const float step = 0.01f * plane.along;
    plane.along += step;
    const PlaneMap moved = picture.map(plane, kCentre, kTarget);
    const float way = glm::distance(map.place, moved.place);
    EXPECT_GT(way, 0.005f) << "parallax shows";
    EXPECT_NEAR(map.pxPerAlong * step, way, 0.1f * way);
}

TEST_P(BlockPlaneMap, ANonFiniteMapIsNotAffine) {
    const PlanePicture picture(GetParam(), makeMove());
    for (const float bad :
         {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
        BlockPlane plane = makePlane(GetParam());
        plane.along = bad;
        EXPECT_FALSE(picture.map(plane, kCentre, kTarget).isAffine);
        plane = makePlane(GetParam());
        plane.slope.y = bad;
        EXPECT_FALSE(picture.map(plane, kCentre, kTarget).isAffine);
    }
}

INSTANTIATE_TEST_SUITE_P(Cameras, BlockPlaneMap, testing::Bool(), [](const auto& camera) {
    return std::string(camera.param ? "Perspective" : "Orthographic");
});

TEST(BlockPlane, DepthMakesNoDifferenceToACameraThatOnlyTurns) {
    const PlanePicture picture(true, glm::rotate(dmat4(1.0), 0.02, dvec3(0, 1, 0)));
    const PlaneMap map = picture.map(makePlane(true), kCentre, kTarget);
    ASSERT_TRUE(map.isAffine);
    EXPECT_LT(map.pxPerAlong, 1e-3f);
    // The sky is a plane infinitely far away.
    const BlockPlane sky{0, 0, 0.0f, math::vec2(0.0f), 0.0f};
    const PlaneMap ofSky = picture.map(sky, kCentre, kTarget);
    ASSERT_TRUE(ofSky.isAffine);
    EXPECT_LT(glm::distance(ofSky.place, map.place), 1e-3f);
}

TEST(BlockPlane, APlaneBehindTheCameraHasNoMap) {
    // The surface is 4 m away, and the camera moves 5.
    const PlanePicture picture(true, glm::translate(dmat4(1.0), dvec3(0, 0, 5)));
    EXPECT_FALSE(picture.map(makePlane(true), kCentre, kTarget).isAffine);
}

TEST(BlockPlane, AMapThatStretchesUnevenlyIsNotAffine) {
    // Nearly edge on at the instant.
    const PlanePicture picture(
        true,
        glm::translate(dmat4(1.0), dvec3(0, 0, -4)) * glm::rotate(dmat4(1.0), 1.2, dvec3(0, 1, 0)) *
            glm::translate(dmat4(1.0), dvec3(0, 0, 4))
    );
    const BlockPlane wall{0, 0, 0.25f, math::vec2(0.0f), 0.0f};
    const PlaneMap map = picture.map(wall, kCentre, math::vec2(360.0f, 150.0f));
    EXPECT_FALSE(map.isAffine);
}

TEST(BlockPlane, TheGapBetweenPlanesIsTheGreatestInTheOthersBlock) {
    const BlockPlane plane{0, 0, 1.0f, math::vec2(0.1f, 0.0f), 0.0f};
    const math::vec2 centre(4.0f, 4.0f);
    const math::vec2 next(12.0f, 4.0f);
    const BlockPlane same{0, 0, 1.8f, math::vec2(0.1f, 0.0f), 0.0f};
    EXPECT_NEAR(shader::planeGap(plane, centre, same, next), 0.0f, 1e-6f);
    const BlockPlane turned{0, 0, 1.8f, math::vec2(0.1f, 0.05f), 0.01f};
    EXPECT_NEAR(shader::planeGap(plane, centre, turned, next), 0.05f * 4.0f + 0.01f, 1e-6f);
}

} // namespace
} // namespace shutter
