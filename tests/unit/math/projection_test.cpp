// SPDX-License-Identifier: MIT
#include "engine/math/projection.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace shutter::math {
namespace {

constexpr double kPi = std::numbers::pi;

dvec3 project(const dmat4& clipFromView, const dvec3& point) {
    const dvec4 clip = clipFromView * dvec4(point, 1.0);
    return dvec3(clip) / clip.w;
}

TEST(Perspective, TheNearPlaneHasDepthOneAndInfinityZero) {
    const dmat4 clipFromView = clipFromViewPerspective(1.0, 1.5, 0.1);
    EXPECT_DOUBLE_EQ(project(clipFromView, {0.0, 0.0, -0.1}).z, 1.0);
    EXPECT_DOUBLE_EQ(project(clipFromView, {0.0, 0.0, -0.2}).z, 0.5);
    EXPECT_NEAR(project(clipFromView, {0.0, 0.0, -1e12}).z, 0.0, 1e-12);
    const dvec4 direction = clipFromView * dvec4(0.0, 0.0, -1.0, 0.0); // the sky
    EXPECT_EQ(direction.z, 0.0);
    EXPECT_EQ(direction.w, 1.0);
}

TEST(Perspective, DepthFallsWithDistance) {
    const dmat4 clipFromView = clipFromViewPerspective(1.0, 1.0, 0.05);
    double previous = 2.0;
    for (const double distance : {0.05, 0.06, 1.0, 10.0, 1e3, 1e6}) {
        const double depth = project(clipFromView, {0.3, 0.2, -distance}).z;
        EXPECT_LT(depth, previous);
        EXPECT_GT(depth, 0.0);
        previous = depth;
    }
}

TEST(Perspective, ClipWIsTheDistanceAlongTheViewDirection) {
    const dmat4 clipFromView = clipFromViewPerspective(0.7, 2.0, 0.1);
    EXPECT_DOUBLE_EQ((clipFromView * dvec4(3.0, -4.0, -12.0, 1.0)).w, 12.0);
}

TEST(Perspective, YPointsDownAndTheFieldOfViewTouchesTheBorder) {
    const dmat4 clipFromView = clipFromViewPerspective(kPi / 2.0, 2.0, 0.1);
    const dvec3 top = project(clipFromView, {0.0, 5.0, -5.0}); // 45 degrees up
    EXPECT_NEAR(top.y, -1.0, 1e-12);
    const dvec3 right = project(clipFromView, {10.0, 0.0, -5.0});
    EXPECT_NEAR(right.x, 1.0, 1e-12);
    EXPECT_EQ(right.y, 0.0);
}

TEST(Orthographic, NearIsOneFarIsZeroAndWIsOne) {
    const dmat4 clipFromView = clipFromViewOrthographic(2.0, 1.0, 0.5, 10.5);
    EXPECT_NEAR(project(clipFromView, {0.0, 0.0, -0.5}).z, 1.0, 1e-12);
    EXPECT_NEAR(project(clipFromView, {0.0, 0.0, -10.5}).z, 0.0, 1e-12);
    EXPECT_NEAR(project(clipFromView, {0.0, 0.0, -5.5}).z, 0.5, 1e-12);
    EXPECT_EQ((clipFromView * dvec4(1.0, 2.0, -3.0, 1.0)).w, 1.0);
}

TEST(Orthographic, TheHalfExtentsTouchTheBorderAndYPointsDown) {
    const dmat4 clipFromView = clipFromViewOrthographic(2.0, 3.0, 0.0, 1.0);
    EXPECT_DOUBLE_EQ(project(clipFromView, {2.0, 0.0, -0.5}).x, 1.0);
    EXPECT_DOUBLE_EQ(project(clipFromView, {0.0, 3.0, -0.5}).y, -1.0);
}

} // namespace
} // namespace shutter::math
