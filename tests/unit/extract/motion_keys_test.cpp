// SPDX-License-Identifier: MIT
// How motions of bodies and of shapes become keys between which rays interpolate.
#include "engine/extract/deformation_keys.h"
#include "engine/extract/deformed_entity.h"
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
using scene::Deformation;

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

TEST(MotionKeys, AStaticEntityHasOneKeyAndAStraightMotionTwo) {
    const MotionKeys keys = compute([](double) { return moved({1.0, 2.0, -3.0}); });
    ASSERT_EQ(keys.keys.size(), 1u);
    EXPECT_TRUE(keys.followsExactly);
    EXPECT_EQ(keys.swept.min, dvec3(0.5, 1.5, -3.5));
    EXPECT_EQ(keys.swept.max, dvec3(1.5, 2.5, -2.5));
    EXPECT_EQ(interpolateKeys(keys.keys, 0.7), moved({1.0, 2.0, -3.0}));
    const MotionKeys straight = compute([](double s) { return moved({s * 3.0, 0.0, -5.0 + s}); });
    ASSERT_EQ(straight.keys.size(), 2u);
    EXPECT_TRUE(straight.followsExactly);
    EXPECT_NEAR(straight.swept.min.x, -0.5, 1e-6);
    EXPECT_NEAR(straight.swept.max.x, 3.5, 1e-6);
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

TEST(MotionKeys, WholeTurnsBetweenProbesAreDetected) {
    // At both ends, or at each sixteenth of the exposure, it has its first pose.
    for (const double turns : {1.0, 16.0, 32.0, 64.0}) {
        const MotionKeys keys =
            compute([&](double s) { return spun(2.0 * glm::pi<double>() * turns * s); });
        EXPECT_GT(keys.keys.size(), turns > 1.0 ? 512u : 16u) << turns;
    }
}

TEST(MotionKeys, NearerMotionHasMoreKeysAndACameraWithinTheBoxIsAsAtTheNearPlane) {
    const MatrixAt matrixAt = [](double s) { return spun(s); };
    KeyTolerance near = perspective();
    near.cameraPath = {dvec3(0.0), dvec3(0.0, 0.0, -4.0)};
    EXPECT_GT(compute(matrixAt, near).keys.size(), compute(matrixAt).keys.size());
    EXPECT_NEAR(perspective().of(unitBox()), kPixelAtOne * 0.05 / 64.0, 1e-12);
}

TEST(MotionKeys, AJumpTakesAllKeysAndIsFlagged) {
    const MatrixAt matrixAt = [](double s) { return moved({s < 0.4 ? 0.0 : 2.0, 0.0, -5.0}); };
    const MotionKeys keys = compute(matrixAt);
    EXPECT_EQ(keys.keys.size(), kMaxKeyIntervals + 1);
    EXPECT_FALSE(keys.followsExactly);
    EXPECT_LT(interpolateKeys(keys.keys, 0.398)[3].x, 1e-6);
    EXPECT_NEAR(interpolateKeys(keys.keys, 0.402)[3].x, 2.0, 1e-6);
}

TEST(MotionKeys, ANonFiniteMatrixHasNoKeys) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const double infinite = std::numeric_limits<double>::infinity();
    for (const double bad : {nan, infinite, 1e300}) { // the last is finite in double precision only
        const MatrixAt matrixAt = [&](double s) { return moved({s > 0.5 ? bad : 0.0, 0.0, -5.0}); };
        EXPECT_FALSE(computeMotionKeys(matrixAt, unitBox(), perspective())) << bad;
    }
}

TEST(MotionKeys, EntitiesScaledToZeroForAWhileHaveKeys) {
    const MotionKeys keys = compute([](double s) {
        return glm::scale(moved({0.0, 0.0, -5.0}), dvec3(std::max(0.0, s - 0.5)));
    });
    EXPECT_EQ(interpolateKeys(keys.keys, 0.2)[0].x, 0.0);
    EXPECT_NEAR(interpolateKeys(keys.keys, 1.0)[0].x, 0.5, 1e-6);
}

TEST(MotionKeys, FarAwayFloatNoiseIsNotChased) {
    // At 100 km a float resolves 8 mm; an orthographic pixel may be finer.
    KeyTolerance tolerance;
    tolerance.cameraPath = {dvec3(0.0)};
    tolerance.pixelAnywhere = 1e-6;
    const MatrixAt matrixAt = [](double s) { return moved({1.0e5 + s, 0.3 * s, -5.0}); };
    EXPECT_EQ(compute(matrixAt, tolerance).keys.size(), 2u);
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

/// A rod of 21 vertices along y, [0, 2], from joint 0 to joint 1, and one morph target.
scene::Primitive makeRod() {
    scene::Primitive rod;
    rod.influenceCount = 4;
    scene::MorphTarget target;
    for (int i = 0; i <= 20; ++i) {
        const float share = float(i) / 20.0f;
        rod.positions.push_back({0.1f, 2.0f * share, 0.0f});
        rod.joints.insert(rod.joints.end(), {0, 1, 0, 0});
        rod.weights.insert(rod.weights.end(), {1.0f - share, share, 0.0f, 0.0f});
        target.positions.push_back({share * share, 0.0f, 0.5f * share});
    }
    rod.morphTargets.push_back(target);
    return rod;
}

const scene::Primitive kRod = makeRod();
const scene::PoseReach kReach = scene::computePoseReach({&kRod, 1});

dvec3 bend(size_t vertex, const Deformation& pose) {
    dvec3 position(kRod.positions[vertex]);
    if (!pose.morphWeights.empty())
        position += pose.morphWeights[0] * dvec3(kRod.morphTargets[0].positions[vertex]);
    const dvec3 morphed = position;
    for (const scene::WavePose::Wave& wave : pose.waves.waves)
        position += std::sin(wave.phase - glm::dot(wave.waveVector, morphed)) * wave.displacement;
    if (pose.objectFromBind.empty())
        return position;
    dvec4 sum(0.0);
    for (size_t i = 0; i < 2; ++i)
        sum +=
            double(kRod.weights[4 * vertex + i]) * (pose.objectFromBind[i] * dvec4(position, 1.0));
    return dvec3(sum);
}

/// Largest distance of a vertex from its straight way between two poses.
double
measureDeviation(const Deformation& exact, const Deformation& a, const Deformation& b, double t) {
    double largest = 0.0;
    for (size_t vertex = 0; vertex < kRod.positions.size(); ++vertex) {
        const dvec3 straight = glm::mix(bend(vertex, a), bend(vertex, b), t);
        largest = std::max(largest, glm::length(bend(vertex, exact) - straight));
    }
    return largest;
}

/// The second joint turns about y = 1, the weight swings, and a wave of `height` metres turns as it
/// runs.
Deformation deformAt(double s, double radians, double swing, double height = 0.0) {
    const dmat4 turned = glm::translate(dmat4(1.0), dvec3(0, 1, 0)) *
                         glm::rotate(dmat4(1.0), radians * s, dvec3(0.6, 0.0, 0.8)) *
                         glm::translate(dmat4(1.0), dvec3(0, -1, 0));
    Deformation pose{{dmat4(1.0), turned}, {swing * std::sin(5.0 * s)}, {}};
    if (height != 0.0)
        pose.waves.waves = {
            {{height, 0.1 * s, 0.0}, {0.3 * s, 2.0, 0.0}, 6.0 * s},
            {{0.0, 0.0, height}, dvec3(0.0), 1.0 - 4.0 * s}};
    return pose;
}

dmat4 placed(double scale) {
    const dvec3 ahead(0, 0, -5.0 * std::max(scale, 1.0));
    return glm::scale(glm::translate(dmat4(1.0), ahead), dvec3(scale));
}

DeformedMotion compute(const DeformationAt& shape, double scale = 1.0) {
    auto motion = computeDeformedMotion(
        [scale](double) { return placed(scale); }, shape, kReach, perspective()
    );
    EXPECT_TRUE(motion.has_value());
    return motion.value_or(DeformedMotion{});
}

/// How far, in camera-relative space, any vertex is from where interpolation between keys puts it.
double findLargestDeviation(
    const DeformationKeys& shape, const DeformationAt& deformAt, double scale = 1.0
) {
    const auto intervals = double(shape.keys.size() - 1);
    double largest = 0.0;
    for (int i = 0; i <= 4999; ++i) {
        const double s = i / 4999.0;
        const auto first = std::min(static_cast<size_t>(s * intervals), shape.keys.size() - 2);
        const double off = measureDeviation(
            deformAt(s), shape.keys[first], shape.keys[first + 1], s * intervals - double(first)
        );
        largest = std::max(largest, scale * off);
    }
    return largest;
}

TEST(DeformationKeys, ABendStaysWithinTheTolerance) {
    for (const double scale : {1.0, 0.05, 20.0})
        for (const double swing : {0.0, 0.4})
            for (const double radians : {0.05, 1.5, 3.0}) {
                const double height = radians == 1.5 ? 0.2 : 0.0;
                const auto shape = [&](double s) { return deformAt(s, radians, swing, height); };
                const DeformedMotion motion = compute(shape, scale);
                ASSERT_TRUE(motion.shape.followsExactly);
                ASSERT_GT(motion.shape.keys.size(), 1u);
                EXPECT_LE(
                    findLargestDeviation(motion.shape, shape, scale),
                    perspective().of(motion.object.swept)
                ) << scale
                  << " " << swing << " " << radians;
            }
}

TEST(DeformationKeys, ABoundIsNeverBelowWhatAVertexDoes) {
    for (int i = 0; i < 400; ++i) {
        const double from = 0.013 * i;
        const double height = i % 2 == 0 ? 0.0 : 0.3;
        const Deformation a = deformAt(from, 2.0, 0.7, height);
        const Deformation b = deformAt(from + 0.2, 2.0, 0.7, height);
        const double t = std::fmod(0.37 * i, 1.0);
        const Deformation exact = deformAt(from + 0.2 * t, 2.0, 0.7, height);
        const double largest = measureDeviation(exact, a, b, t);
        const double bound = measureDeformationDeviation(exact, a, b, t, kReach);
        EXPECT_LE(largest, bound * (1.0 + 1e-12));
        EXPECT_LE(bound, 20.0 * largest + 1e-3) << "so loose that it costs keys";
    }
}

TEST(DeformationKeys, ABoundHoldsWavesThatTurnAndWavesUnderASkinThatMoves) {
    // All else is on its straight way: only the turn, or skin and wave together, leave it.
    const auto turning = [](double t) {
        Deformation pose;
        pose.waves.waves = {{{0.2, 0.0, 0.0}, {0.0, 3.0 * t, 0.0}, 0.4}};
        return pose;
    };
    const auto skinned = [](double t) {
        const dmat4 stretched = glm::scale(dmat4(1.0), dvec3(1.0 + 2.0 * t));
        Deformation pose{{stretched, stretched}, {}, {}};
        pose.waves.waves = {{{0.3 * t, 0.0, 0.0}, dvec3(0.0), 1.5}};
        return pose;
    };
    for (const DeformationAt& pose : {DeformationAt(turning), {skinned}}) {
        const double off = measureDeviation(pose(0.5), pose(0.0), pose(1.0), 0.5);
        EXPECT_GT(off, 0.01);
        EXPECT_LE(
            off, measureDeformationDeviation(pose(0.5), pose(0.0), pose(1.0), 0.5, kReach) + 1e-12
        );
    }
}

TEST(DeformationKeys, PosesThatDifferInWavesAloneAreNotOneShape) {
    const Deformation a = deformAt(0.0, 0.0, 0.0, 0.1);
    Deformation b = a;
    EXPECT_TRUE(isNear(a, b, kReach, 0.0));
    b.waves.waves[0].phase += 0.1;
    EXPECT_FALSE(isSame(a, b));
    EXPECT_FALSE(isNear(a, b, kReach, 1e-3));
}

TEST(DeformationKeys, SweptBoxesHoldEveryVertexAtEveryTime) {
    const auto shape = [](double s) { return deformAt(s, 4.0, 0.5, 0.4); };
    const DeformedMotion motion = compute(shape);
    for (int i = 0; i <= 997; ++i)
        for (size_t vertex = 0; vertex < kRod.positions.size(); ++vertex) {
            const dvec3 object = bend(vertex, shape(i / 997.0));
            const dvec3 eye(placed(1.0) * dvec4(object, 1.0));
            for (int axis = 0; axis < 3; ++axis) {
                EXPECT_GE(object[axis], motion.shape.swept.min[axis] - 1e-4);
                EXPECT_LE(object[axis], motion.shape.swept.max[axis] + 1e-4);
                EXPECT_GE(eye[axis], motion.object.swept.min[axis] - 1e-4);
                EXPECT_LE(eye[axis], motion.object.swept.max[axis] + 1e-4);
            }
        }
}

TEST(DeformationKeys, AStraightMorphHasTwoKeysAndAJumpAll) {
    const auto straight = [](double s) { return Deformation{{}, {2.0 * s}, {}}; };
    EXPECT_EQ(compute(straight).shape.keys.size(), 2u);
    const auto jumping = [](double s) { return Deformation{{}, {s < 0.4 ? 0.0 : 1.0}, {}}; };
    const DeformedMotion motion = compute(jumping);
    EXPECT_FALSE(motion.shape.followsExactly);
    EXPECT_EQ(motion.shape.keys.size(), kMaxDeformationIntervals + 1u);
}

TEST(DeformationKeys, AShapeThatIsNotFiniteForAWhileHasNoKeys) {
    const auto still = [](double) { return placed(1.0); };
    for (const double bad :
         {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
        const auto weights = [bad](double s) {
            return Deformation{{}, {s > 0.4 && s < 0.6 ? bad : s}, {}};
        };
        EXPECT_FALSE(computeDeformedMotion(still, weights, kReach, perspective()));
        const auto joints = [bad](double s) {
            Deformation pose = deformAt(s, 1.0, 0.0);
            if (s > 0.4 && s < 0.6)
                pose.objectFromBind[1][3][0] = bad;
            return pose;
        };
        EXPECT_FALSE(computeDeformedMotion(still, joints, kReach, perspective()));
    }
}

} // namespace
} // namespace shutter::extract
