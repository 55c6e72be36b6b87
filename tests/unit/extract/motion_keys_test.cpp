// SPDX-License-Identifier: MIT
#include "engine/extract/motion_keys.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace shutter::extract {

namespace {

using math::Bounds;
using math::dmat4;
using math::dvec3;
using math::dvec4;

constexpr double kPixelAtOne = 2.0e-3;

Bounds unitBox() {
    Bounds box;
    box.add(dvec3(-0.5));
    box.add(dvec3(0.5));
    return box;
}

KeyTolerance perspective() {
    KeyTolerance tolerance;
    tolerance.cameraPath = {dvec3(0.0)};
    tolerance.near = 0.05;
    tolerance.pixelAtOne = kPixelAtOne;
    return tolerance;
}

dmat4 moved(const dvec3& by) {
    return glm::translate(dmat4(1.0), by);
}

dmat4 spun(double radians) {
    return glm::rotate(moved({0.0, 0.0, -5.0}), radians, dvec3(0.3, 1.0, -0.2));
}

MotionKeys compute(const MatrixAt& matrixAt, const KeyTolerance& tolerance = perspective()) {
    auto keys = computeMotionKeys(matrixAt, unitBox(), tolerance);
    EXPECT_TRUE(keys.has_value());
    return keys.value_or(MotionKeys{});
}

/// Largest distance of interpolated corners from the true ones, at many times.
double findLargestDeviation(const MotionKeys& keys, const MatrixAt& matrixAt) {
    double largest = 0.0;
    for (int i = 0; i <= 9973; ++i) {
        const double s = i / 9973.0;
        const dmat4 difference = interpolateKeys(keys.keys, s) - matrixAt(s);
        for (const double x : {-0.5, 0.5})
            for (const double y : {-0.5, 0.5})
                for (const double z : {-0.5, 0.5})
                    largest =
                        std::max(largest, glm::length(dvec3(difference * dvec4(x, y, z, 1.0))));
    }
    return largest;
}

} // namespace

TEST(MotionKeys, WhatStandsStillHasOneKey) {
    const MotionKeys keys = compute([](double) { return moved({1.0, 2.0, -3.0}); });
    ASSERT_EQ(keys.keys.size(), 1u);
    EXPECT_TRUE(keys.followsExactly);
    EXPECT_EQ(keys.swept.min, dvec3(0.5, 1.5, -3.5));
    EXPECT_EQ(keys.swept.max, dvec3(1.5, 2.5, -2.5));
    EXPECT_EQ(interpolateKeys(keys.keys, 0.7), moved({1.0, 2.0, -3.0}));
}

TEST(MotionKeys, AStraightWayHasTwo) {
    const MotionKeys keys = compute([](double s) { return moved({s * 3.0, 0.0, -5.0 + s}); });
    ASSERT_EQ(keys.keys.size(), 2u);
    EXPECT_TRUE(keys.followsExactly);
    EXPECT_NEAR(keys.swept.min.x, -0.5, 1e-6);
    EXPECT_NEAR(keys.swept.max.x, 3.5, 1e-6);
}

TEST(MotionKeys, ASpinStaysWithinTheTolerance) {
    for (const double radians : {0.01, 0.5, 6.0, 30.0}) {
        const MatrixAt matrixAt = [&](double s) { return spun(radians * s); };
        const MotionKeys keys = compute(matrixAt);
        EXPECT_TRUE(keys.followsExactly) << radians;
        const double allowed = perspective().of(keys.swept);
        // The middle of an interval is where a chord is farthest from its arc.
        EXPECT_LE(findLargestDeviation(keys, matrixAt), allowed * 1.01) << radians;
        EXPECT_NEAR(allowed, kPixelAtOne / 64.0 * (5.0 - 0.9), kPixelAtOne / 64.0) << radians;
    }
}

TEST(MotionKeys, AWholeTurnIsNotStandingStill) {
    // Where it began and where it ended are the same.
    const MotionKeys keys = compute([](double s) { return spun(2.0 * glm::pi<double>() * s); });
    EXPECT_GT(keys.keys.size(), 16u);
}

TEST(MotionKeys, WholeTurnsThatFitTheInstantsAreSeen) {
    // At each sixteenth of the exposure it stands as at first.
    for (const double turns : {16.0, 32.0, 64.0}) {
        const MotionKeys keys =
            compute([&](double s) { return spun(2.0 * glm::pi<double>() * turns * s); });
        EXPECT_GT(keys.keys.size(), 512u) << turns;
    }
}

TEST(MotionKeys, MoreKeysTheNearerTheCamera) {
    const MatrixAt matrixAt = [](double s) { return spun(s); };
    KeyTolerance near = perspective();
    near.cameraPath = {dvec3(0.0), dvec3(0.0, 0.0, -4.0)};
    EXPECT_GT(compute(matrixAt, near).keys.size(), compute(matrixAt).keys.size());
}

TEST(MotionKeys, AMotionThatBeginsWithinTheExposureIsSeen) {
    const MotionKeys keys = compute([](double s) {
        return moved({std::max(0.0, s - 0.93), 0.0, -5.0});
    });
    EXPECT_GT(keys.keys.size(), 2u);
    EXPECT_NEAR(keys.swept.max.x, 0.57, 1e-6);
}

TEST(MotionKeys, AJumpTakesAllKeysAndSaysSo) {
    const MatrixAt matrixAt = [](double s) { return moved({s < 0.4 ? 0.0 : 2.0, 0.0, -5.0}); };
    const MotionKeys keys = compute(matrixAt);
    EXPECT_EQ(keys.keys.size(), kMaxKeyIntervals + 1);
    EXPECT_FALSE(keys.followsExactly);
    EXPECT_LT(interpolateKeys(keys.keys, 0.398)[3].x, 1e-6);
    EXPECT_NEAR(interpolateKeys(keys.keys, 0.402)[3].x, 2.0, 1e-6);
}

TEST(MotionKeys, AMatrixThatIsNotFiniteHasNone) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const double infinite = std::numeric_limits<double>::infinity();
    for (const double bad : {nan, infinite}) {
        const MatrixAt matrixAt = [&](double s) { return moved({s > 0.5 ? bad : 0.0, 0.0, -5.0}); };
        EXPECT_FALSE(computeMotionKeys(matrixAt, unitBox(), perspective()).has_value());
    }
    // Finite in double precision only.
    EXPECT_FALSE(computeMotionKeys(
                     [](double s) {
                         return moved({s * 1e300, 0.0, 0.0});
                     },
                     unitBox(),
                     perspective()
    )
                     .has_value());
}

TEST(MotionKeys, WhatIsScaledToNothingForAWhileHasKeys) {
    const MotionKeys keys = compute([](double s) {
        return glm::scale(moved({0.0, 0.0, -5.0}), dvec3(std::max(0.0, s - 0.5)));
    });
    EXPECT_EQ(interpolateKeys(keys.keys, 0.2)[0].x, 0.0);
    EXPECT_NEAR(interpolateKeys(keys.keys, 1.0)[0].x, 0.5, 1e-6);
}

TEST(MotionKeys, FarAwayFloatNoiseIsNotChased) {
    // At 100 km a float tells 8 mm apart; an orthographic pixel may be finer.
    KeyTolerance tolerance;
    tolerance.cameraPath = {dvec3(0.0)};
    tolerance.pixelAnywhere = 1e-6;
    const MotionKeys keys = compute(
        [](double s) {
            return moved({1.0e5 + s, 0.3 * s, -5.0});
        },
        tolerance
    );
    EXPECT_EQ(keys.keys.size(), 2u);
}

TEST(MotionKeys, TheCameraWithinTheBoxCountsAsAtTheNearPlane) {
    EXPECT_NEAR(perspective().of(unitBox()), kPixelAtOne * 0.05 / 64.0, 1e-12);
}

TEST(MotionKeys, ACameraThatTurnsFollowsToAShareOfAPixel) {
    const math::dvec2 half(0.5, 0.3);
    const MatrixAt pan = [](double s) {
        return glm::rotate(dmat4(1.0), 0.4 * s, dvec3(0.0, 1.0, 0.0));
    };
    const auto keys = computeCameraKeys(pan, half, perspective());
    ASSERT_TRUE(keys.has_value());
    for (int i = 0; i <= 1000; ++i) {
        const double s = i / 1000.0;
        const dvec3 direction(half, -1.0);
        const dvec3 exact = dvec3(pan(s) * dvec4(direction, 0.0));
        const dvec3 found = dvec3(interpolateKeys(keys->keys, s) * dvec4(direction, 0.0));
        ASSERT_LE(glm::length(exact - found), kPixelAtOne / 64.0 * 1.01);
    }
    EXPECT_GT(keys->keys.size(), 4u);
    EXPECT_EQ(
        computeCameraKeys([&](double) { return pan(1.0); }, half, perspective())->keys.size(), 1u
    );
}

} // namespace shutter::extract
