// SPDX-License-Identifier: MIT
// Transforms, poses between them, and bounds.
#include "engine/math/bounds.h"
#include "engine/math/transform.h"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>

namespace shutter::math {
namespace {

constexpr double kPi = std::numbers::pi;

void expectNear(const dvec3& actual, const dvec3& expected, double tolerance = 1e-12) {
    EXPECT_NEAR(actual.x, expected.x, tolerance);
    EXPECT_NEAR(actual.y, expected.y, tolerance);
    EXPECT_NEAR(actual.z, expected.z, tolerance);
}

dvec3 applyTo(const dmat4& matrix, const dvec3& point) {
    return dvec3(matrix * dvec4(point, 1.0));
}

dquat quarterTurnZ() {
    return glm::angleAxis(kPi / 2.0, dvec3(0.0, 0.0, 1.0));
}

dquat tilt() {
    return glm::angleAxis(0.7, glm::normalize(dvec3(1.0, 2.0, 3.0)));
}

TEST(RemoveScale, PlaceAndDirectionsArePreserved) {
    Transform transform{{1.0, -2.0, 3.0}, tilt(), dvec3(1.0)};
    const dmat4 rigid = computeMatrix(transform);
    transform.scale = {5.0, 0.001, 7e8};
    const dmat4 found = removeScale(computeMatrix(transform));
    for (int column = 0; column < 4; ++column)
        expectNear(dvec3(found[column]), dvec3(rigid[column]));
    // Without directions the place stays.
    const dmat4 moved = glm::translate(dmat4(1.0), dvec3(1.0, 2.0, 3.0));
    for (const double bad : {0.0, std::numeric_limits<double>::quiet_NaN()}) {
        dmat4 flat = moved;
        flat[0][0] = bad;
        EXPECT_EQ(removeScale(flat), moved);
    }
}

TEST(RemoveScale, ShearAndMirroringGoAndTheDirectionOfSightStays) {
    for (const dvec3& mirror :
         {dvec3(1, 1, 1), dvec3(-1, 1, 1), dvec3(1, -1, 1), dvec3(1, 1, -1), dvec3(-1, -1, -1)}) {
        // Rotated, and then scaled along other axes.
        const dmat4 matrix = glm::scale(dmat4(1.0), mirror * dvec3(1.0, 3.0, 0.5)) *
                             computeMatrix({{1.0, 2.0, 3.0}, tilt(), dvec3(1.0)});
        const dmat4 found = removeScale(matrix);
        const dmat3 axes(found);
        for (int column = 0; column < 3; ++column)
            expectNear((glm::transpose(axes) * axes)[column], dmat3(1.0)[column]);
        EXPECT_NEAR(glm::determinant(axes), 1.0, 1e-12);
        expectNear(axes[2], glm::normalize(dvec3(matrix[2])));
        EXPECT_GT(glm::dot(axes[1], dvec3(matrix[1])), 0.0) << "up";
        EXPECT_NEAR(
            glm::dot(axes[0], glm::cross(dvec3(matrix[1]), dvec3(matrix[2]))),
            glm::length(glm::cross(dvec3(matrix[1]), dvec3(matrix[2]))),
            1e-12
        );
        EXPECT_EQ(found[3], matrix[3]);
    }
}

TEST(RemoveScale, AxesThatAreSquareUpToRoundingAreOnlyMadeOneLong) {
    dmat4 matrix = glm::mat4_cast(tilt());
    matrix[1] += 1e-7 * matrix[2]; // as a file of single precision has them
    const dmat4 found = removeScale(matrix);
    for (int column = 0; column < 3; ++column)
        EXPECT_EQ(dvec3(found[column]), dvec3(matrix[column]) / glm::length(dvec3(matrix[column])));
}

TEST(RemoveScale, TwoRemainingDirectionsDetermineTheThird) {
    const dmat3 turn = glm::mat3_cast(tilt());
    for (int lost = 0; lost < 3; ++lost) {
        dmat3 axes = turn * 1e-200;
        axes[lost] = dvec3(0.0);
        const auto found = findRigid(dmat4(axes));
        ASSERT_TRUE(found) << lost;
        for (int column = 0; column < 3; ++column)
            expectNear(dvec3((*found)[column]), turn[column]);
    }
    dmat4 flat(turn); // pressed into a plane: all three are left, and lie in it
    for (int column = 0; column < 3; ++column)
        flat[column].z = 0.0;
    const auto found = findRigid(flat);
    ASSERT_TRUE(found);
    EXPECT_NEAR(glm::determinant(dmat3(*found)), 1.0, 1e-12);
    expectNear(dvec3((*found)[2]), glm::normalize(dvec3(flat[2])));
    for (int axis = 0; axis < 3; ++axis) {
        dmat4 line(0.0);
        line[axis].x = 1.0;
        EXPECT_FALSE(findRigid(line)) << "one direction";
    }
    EXPECT_FALSE(findRigid(dmat4(0.0)));
}

TEST(Transform, ScalesThenRotatesThenTranslatesAndMayMirrorOrFlatten) {
    const Transform transform{{10.0, 20.0, 30.0}, quarterTurnZ(), {2.0, 3.0, 4.0}};
    // (1, 1, 1) scaled is (2, 3, 4), turned (-3, 2, 4), moved (7, 22, 34).
    expectNear(applyTo(computeMatrix(transform), {1.0, 1.0, 1.0}), {7.0, 22.0, 34.0});
    const dmat4 mirror = computeMatrix({dvec3(0.0), quarterTurnZ(), {-1.0, 1.0, 1.0}});
    expectNear(applyTo(mirror, {1.0, 0.0, 0.0}), {0.0, -1.0, 0.0});
    EXPECT_NEAR(glm::determinant(dmat3(mirror)), -1.0, 1e-12);
    const dmat4 flat = computeMatrix({{1.0, 2.0, 3.0}, quarterTurnZ(), dvec3(0.0)});
    EXPECT_TRUE(isFinite(flat));
    EXPECT_EQ(applyTo(flat, {5.0, 6.0, 7.0}), dvec3(1.0, 2.0, 3.0));
}

TEST(IntegrateRotation, RotationIsExactlyTheIdentityWhereNothingTurns) {
    const dquat identity(1.0, 0.0, 0.0, 0.0);
    EXPECT_EQ(integrateRotation(dvec3(0.0), 123.0), identity);
    EXPECT_EQ(integrateRotation({0.0, 5.0, 0.0}, 0.0), identity);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(integrateRotation({nan, 0.0, 0.0}, 1.0), identity);
    EXPECT_NEAR(integrateRotation({1e-12, 0.0, 0.0}, 1.0).x, 5e-13, 1e-24) << "it still turns";
}

TEST(IntegrateRotation, RotationIsCounterClockwiseAndManyTurnsKeepTheAngleAndTheLength) {
    const dvec3 x(1.0, 0.0, 0.0);
    expectNear(integrateRotation({0.0, 0.0, kPi / 2.0}, 1.0) * x, {0.0, 1.0, 0.0});
    expectNear(integrateRotation({0.0, 0.0, kPi / 2.0}, -1.0) * x, {0.0, -1.0, 0.0});
    // 1,000 turns and a quarter.
    const dquat rotation = integrateRotation({0.0, 0.0, 2.0 * kPi}, 1000.25);
    expectNear(rotation * x, {0.0, 1.0, 0.0}, 1e-9);
    EXPECT_NEAR(glm::length(rotation), 1.0, 1e-12);
}

TEST(IsFinite, ASingleBadElementIsFoundAnywhere) {
    EXPECT_TRUE(isFinite(dmat4(1.0)));
    for (int column = 0; column < 4; ++column) {
        for (int row = 0; row < 4; ++row) {
            dmat4 matrix(1.0);
            matrix[column][row] = std::numeric_limits<double>::quiet_NaN();
            EXPECT_FALSE(isFinite(matrix)) << column << ", " << row;
            matrix[column][row] = -std::numeric_limits<double>::infinity();
            EXPECT_FALSE(isFinite(matrix)) << column << ", " << row;
        }
    }
}

dvec3 project(const dmat4& clipFromView, const dvec3& point) {
    const dvec4 clip = clipFromView * dvec4(point, 1.0);
    return dvec3(clip) / clip.w;
}

TEST(Perspective, DepthFallsFromOneAtTheNearPlaneToZeroAtInfinityAndWIsTheDistance) {
    const dmat4 clipFromView = clipFromViewPerspective(1.0, 1.5, 0.1);
    EXPECT_DOUBLE_EQ(project(clipFromView, {0.0, 0.0, -0.1}).z, 1.0);
    EXPECT_DOUBLE_EQ(project(clipFromView, {0.0, 0.0, -0.2}).z, 0.5);
    EXPECT_NEAR(project(clipFromView, {0.0, 0.0, -1e12}).z, 0.0, 1e-12);
    const dvec4 direction = clipFromView * dvec4(0.0, 0.0, -1.0, 0.0); // the sky
    EXPECT_EQ(direction.z, 0.0);
    EXPECT_EQ(direction.w, 1.0);
    double previous = 2.0;
    for (const double distance : {0.1, 0.11, 1.0, 12.0, 1e3, 1e6}) {
        const double depth = project(clipFromView, {0.3, 0.2, -distance}).z;
        EXPECT_LT(depth, previous);
        EXPECT_GT(depth, 0.0);
        previous = depth;
        EXPECT_DOUBLE_EQ((clipFromView * dvec4(3.0, -4.0, -distance, 1.0)).w, distance);
    }
}

TEST(Perspective, YPointsDownAndTheFieldOfViewTouchesTheBorder) {
    const dmat4 clipFromView = clipFromViewPerspective(kPi / 2.0, 2.0, 0.1);
    const dvec3 top = project(clipFromView, {0.0, 5.0, -5.0}); // 45 degrees up
    EXPECT_NEAR(top.y, -1.0, 1e-12);
    const dvec3 right = project(clipFromView, {10.0, 0.0, -5.0});
    EXPECT_NEAR(right.x, 1.0, 1e-12);
    EXPECT_EQ(right.y, 0.0);
}

TEST(Orthographic, NearIsOneFarIsZeroWIsOneAndTheHalfExtentsTouchTheBorder) {
    const dmat4 clipFromView = clipFromViewOrthographic(2.0, 3.0, 0.5, 10.5);
    EXPECT_NEAR(project(clipFromView, {0.0, 0.0, -0.5}).z, 1.0, 1e-12);
    EXPECT_NEAR(project(clipFromView, {0.0, 0.0, -10.5}).z, 0.0, 1e-12);
    EXPECT_NEAR(project(clipFromView, {0.0, 0.0, -5.5}).z, 0.5, 1e-12);
    EXPECT_EQ((clipFromView * dvec4(1.0, 2.0, -3.0, 1.0)).w, 1.0);
    EXPECT_DOUBLE_EQ(project(clipFromView, {2.0, 0.0, -0.5}).x, 1.0);
    EXPECT_DOUBLE_EQ(project(clipFromView, {0.0, 3.0, -0.5}).y, -1.0) << "y points down";
}

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

void expectRigidBetween(const dmat4& own) {
    const Pose open = takeApart(poseAt(0.0, own));
    const Pose close = takeApart(poseAt(1.0, own));
    EXPECT_TRUE(open.isRegular);
    for (const double share : kShares)
        expectNear(interpolate(open, close, share), poseAt(share, own), 1e-9);
}

TEST(Pose, ATurningBodyWithAnyScaleShearOrMirroringIsInterpolatedAlongItsPath) {
    dmat4 own(1.0);
    expectRigidBetween(own);
    own[0] = {0.001, 0.0, 0.0, 0.0};
    own[1] = {0.3, 70.0, 0.0, 0.0};
    own[2] = {0.0, -0.2, 1.5, 0.0};
    expectRigidBetween(own);
    own[2] = -own[2];
    expectRigidBetween(own);
    EXPECT_TRUE(takeApart(dmat4(1.0e-100 * dmat3(own))).isRegular);
    const dmat4 from = poseAt(0.1, dmat4(1.0));
    const dmat4 to = poseAt(0.7, dmat4(1.0));
    EXPECT_EQ(interpolate(takeApart(from), takeApart(to), 0.0), from) << "to the bit";
    EXPECT_EQ(interpolate(takeApart(from), takeApart(to), 1.0), to);
}

TEST(Pose, MatricesWithoutRotationAreMixedAndThoseThatAreNotFiniteNotDecomposed) {
    const dmat4 from = poseAt(0.0, dmat4(1.0));
    dmat4 flat = from;
    flat[2] = dvec4(0.0);
    EXPECT_FALSE(takeApart(flat).isRegular);
    expectNear(interpolate(takeApart(from), takeApart(flat), 0.5), 0.5 * (from + flat), 1e-9);
    dmat4 mirrored = from;
    mirrored[0] = -mirrored[0];
    const dmat4 half = interpolate(takeApart(from), takeApart(mirrored), 0.5);
    expectNear(half, 0.5 * (from + mirrored), 1e-9);
    dmat4 broken(1.0);
    broken[1][1] = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(takeApart(broken).isRegular);
    broken[1][1] = std::numeric_limits<double>::infinity();
    EXPECT_FALSE(takeApart(broken).isRegular);
    EXPECT_FALSE(takeApart(dmat4(0.0)).isRegular);
}

TEST(Bounds, BoundsAreEmptyUntilAPointIsAddedAndGrowToContainEveryPoint) {
    Bounds bounds;
    EXPECT_TRUE(bounds.isEmpty());
    bounds.add(Bounds{});
    EXPECT_TRUE(bounds.isEmpty());
    EXPECT_TRUE(transformBounds(dmat4(2.0), bounds).isEmpty());
    bounds.add(dvec3(1.0, -2.0, 3.0));
    EXPECT_FALSE(bounds.isEmpty());
    EXPECT_EQ(bounds.centre(), dvec3(1.0, -2.0, 3.0));
    EXPECT_EQ(bounds.size(), dvec3(0.0));
    bounds.add(dvec3(-1.0, 4.0, 3.5));
    bounds.add(dvec3(0.0, 0.0, 3.2));
    bounds.add(Bounds{});
    EXPECT_EQ(bounds.min, dvec3(-1.0, -2.0, 3.0));
    EXPECT_EQ(bounds.max, dvec3(1.0, 4.0, 3.5));
    EXPECT_EQ(bounds.centre(), dvec3(0.0, 1.0, 3.25));
    EXPECT_EQ(bounds.size(), dvec3(2.0, 6.0, 0.5));
    Bounds both;
    both.add(dvec3(0.0, 9.0, 3.1));
    both.add(bounds);
    EXPECT_EQ(both.min, dvec3(-1.0, -2.0, 3.0));
    EXPECT_EQ(both.max, dvec3(1.0, 9.0, 3.5));
}

TEST(TransformBounds, ATurnedBoxIsBoxedAgainAndAMirrorKeepsMinBelowMax) {
    Bounds box;
    box.add(dvec3(-1.0));
    box.add(dvec3(1.0));
    const dmat4 turn = glm::rotate(dmat4(1.0), kPi / 4.0, dvec3(0.0, 0.0, 1.0));
    const Bounds turned =
        transformBounds(glm::translate(dmat4(1.0), dvec3(5.0, 0.0, 0.0)) * turn, box);
    EXPECT_NEAR(turned.min.x, 5.0 - std::numbers::sqrt2, 1e-12);
    EXPECT_NEAR(turned.max.x, 5.0 + std::numbers::sqrt2, 1e-12);
    EXPECT_NEAR(turned.max.y, std::numbers::sqrt2, 1e-12);
    EXPECT_NEAR(turned.min.z, -1.0, 1e-12);
    box.add(dvec3(2.0, 3.0, 4.0));
    const Bounds mirrored = transformBounds(glm::scale(dmat4(1.0), dvec3(-1.0, 1.0, 0.0)), box);
    EXPECT_EQ(mirrored.min, dvec3(-2.0, -1.0, 0.0));
    EXPECT_EQ(mirrored.max, dvec3(1.0, 3.0, 0.0));
}

} // namespace
} // namespace shutter::math
