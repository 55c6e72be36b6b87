// SPDX-License-Identifier: MIT
// Between two placements of a body: still a body, on its way.
#include "engine/math/transform.h"

#include <gtest/gtest.h>

#include <limits>

namespace shutter::math {
namespace {

constexpr double kShares[] = {0.0, 0.125, 0.5, 0.875, 1.0};

void expectNear(const dmat4& actual, const dmat4& expected, double tolerance) {
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row)
            EXPECT_NEAR(actual[column][row], expected[column][row], tolerance)
                << column << ", " << row;
}

/// A body that goes and turns, t in [0, 1], by less than half a turn; `own` is its shape's matrix.
dmat4 poseAt(double t, const dmat4& own) {
    Transform transform;
    transform.translation = {3.0 - 2.0 * t, 100.0 * t, -1.0e6};
    transform.rotation = glm::angleAxis(0.3 + 2.5 * t, glm::normalize(dvec3(1.0, -2.0, 0.5)));
    return computeMatrix(transform) * own;
}

void expectRigidBetween(const dmat4& own, double tolerance) {
    const Pose open = takeApart(poseAt(0.0, own));
    const Pose close = takeApart(poseAt(1.0, own));
    EXPECT_TRUE(open.isRegular);
    for (const double share : kShares)
        expectNear(interpolate(open, close, share), poseAt(share, own), tolerance);
}

TEST(Pose, ATurningBodyIsWhereItsWayLeads) {
    expectRigidBetween(dmat4(1.0), 1e-9);
}

TEST(Pose, SoItIsWithAnyScaleShearOrMirroring) {
    dmat4 own(1.0);
    own[0] = {0.001, 0.0, 0.0, 0.0};
    own[1] = {0.3, 70.0, 0.0, 0.0};
    own[2] = {0.0, -0.2, 1.5, 0.0};
    expectRigidBetween(own, 1e-9);
    own[2] = -own[2];
    expectRigidBetween(own, 1e-9);
    EXPECT_TRUE(takeApart(dmat4(1.0e-100 * dmat3(own))).isRegular);
}

TEST(Pose, AtItsEndsItHasTheirBits) {
    const dmat4 from = poseAt(0.1, dmat4(1.0));
    const dmat4 to = poseAt(0.7, dmat4(1.0));
    EXPECT_EQ(interpolate(takeApart(from), takeApart(to), 0.0), from);
    EXPECT_EQ(interpolate(takeApart(from), takeApart(to), 1.0), to);
}

TEST(Pose, WhatHasNoRotationIsMixed) {
    const dmat4 from = poseAt(0.0, dmat4(1.0));
    dmat4 flat = from;
    flat[2] = dvec4(0.0);
    EXPECT_FALSE(takeApart(flat).isRegular);
    expectNear(interpolate(takeApart(from), takeApart(flat), 0.5), 0.5 * (from + flat), 1e-9);
    dmat4 mirrored = from;
    mirrored[0] = -mirrored[0];
    const dmat4 half = interpolate(takeApart(from), takeApart(mirrored), 0.5);
    expectNear(half, 0.5 * (from + mirrored), 1e-9);
}

TEST(Pose, WhatIsNotFiniteIsLeftWhole) {
    dmat4 broken(1.0);
    broken[1][1] = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(takeApart(broken).isRegular);
    broken[1][1] = std::numeric_limits<double>::infinity();
    EXPECT_FALSE(takeApart(broken).isRegular);
    EXPECT_FALSE(takeApart(dmat4(0.0)).isRegular);
}

} // namespace
} // namespace shutter::math
