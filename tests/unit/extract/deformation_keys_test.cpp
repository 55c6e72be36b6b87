// SPDX-License-Identifier: MIT
#include "engine/extract/deformation_keys.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace shutter::extract {

namespace {

using math::dmat4;
using math::dvec3;
using math::dvec4;
using scene::Deformation;

constexpr double kPixelAtOne = 2.0e-3;

KeyTolerance perspective() {
    KeyTolerance tolerance;
    tolerance.cameraPath = {dvec3(0.0)};
    tolerance.near = 0.05;
    tolerance.pixelAtOne = kPixelAtOne;
    return tolerance;
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

dvec3 bend(const scene::Primitive& rod, size_t vertex, const Deformation& pose) {
    dvec3 position(rod.positions[vertex]);
    if (!pose.morphWeights.empty())
        position += pose.morphWeights[0] * dvec3(rod.morphTargets[0].positions[vertex]);
    if (pose.objectFromBind.empty())
        return position;
    dvec4 sum(0.0);
    for (size_t i = 0; i < 2; ++i)
        sum +=
            double(rod.weights[4 * vertex + i]) * (pose.objectFromBind[i] * dvec4(position, 1.0));
    return dvec3(sum);
}

/// The second joint turns about y = 1, and the weight swings.
Deformation deformAt(double s, double radians, double swing) {
    const dmat4 turned = glm::translate(dmat4(1.0), dvec3(0, 1, 0)) *
                         glm::rotate(dmat4(1.0), radians * s, dvec3(0.6, 0.0, 0.8)) *
                         glm::translate(dmat4(1.0), dvec3(0, -1, 0));
    return {{dmat4(1.0), turned}, {swing * std::sin(5.0 * s)}};
}

dmat4 placed(double scale) {
    const dvec3 ahead(0, 0, -5.0 * std::max(scale, 1.0));
    return glm::scale(glm::translate(dmat4(1.0), ahead), dvec3(scale));
}

DeformedMotion compute(const DeformationAt& shape, double scale = 1.0) {
    const scene::Primitive rod = makeRod();
    auto motion = computeDeformedMotion(
        [scale](double) { return placed(scale); },
        shape,
        scene::computePoseReach({&rod, 1}),
        perspective()
    );
    EXPECT_TRUE(motion.has_value());
    return motion.value_or(DeformedMotion{});
}

/// How far, in eye space, any vertex is from where interpolation between keys puts it.
double findLargestDeviation(
    const DeformationKeys& shape, const DeformationAt& deformAt, double scale = 1.0
) {
    const scene::Primitive rod = makeRod();
    const auto intervals = double(shape.keys.size() - 1);
    double largest = 0.0;
    for (int i = 0; i <= 4999; ++i) {
        const double s = i / 4999.0;
        const auto first = std::min(static_cast<size_t>(s * intervals), shape.keys.size() - 2);
        const double t = s * intervals - double(first);
        const Deformation exact = deformAt(s);
        for (size_t vertex = 0; vertex < rod.positions.size(); ++vertex) {
            const dvec3 straight = glm::mix(
                bend(rod, vertex, shape.keys[first]), bend(rod, vertex, shape.keys[first + 1]), t
            );
            const dvec3 off = bend(rod, vertex, exact) - straight;
            largest = std::max(largest, scale * glm::length(off));
        }
    }
    return largest;
}

} // namespace

TEST(DeformationKeys, AShapeThatStandsStillHasOneKey) {
    const DeformedMotion motion = compute([](double) { return deformAt(0.3, 1.0, 0.5); });
    EXPECT_EQ(motion.shape.keys.size(), 1u);
    EXPECT_EQ(motion.object.keys.size(), 1u);
    EXPECT_TRUE(motion.shape.followsExactly);
}

TEST(DeformationKeys, ABendStaysWithinTheTolerance) {
    for (const double scale : {1.0, 0.05, 20.0})
        for (const double swing : {0.0, 0.4})
            for (const double radians : {0.05, 1.5, 3.0}) {
                const auto shape = [&](double s) { return deformAt(s, radians, swing); };
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

TEST(DeformationKeys, AMorphWithoutASkinStaysWithinTheTolerance) {
    const auto shape = [](double s) { return Deformation{{}, {s * s * 3.0}}; };
    const DeformedMotion motion = compute(shape);
    EXPECT_GT(motion.shape.keys.size(), 2u);
    EXPECT_LE(findLargestDeviation(motion.shape, shape), perspective().of(motion.object.swept));
}

TEST(DeformationKeys, AStraightMorphHasTwoKeys) {
    EXPECT_EQ(compute([](double s) { return Deformation{{}, {2.0 * s}}; }).shape.keys.size(), 2u);
}

TEST(DeformationKeys, AMorphOfATurningBoneCountsTheirProduct) {
    // Matrices and weights go straight each; the vertices, which are products of both, do not.
    const auto shape = [](double s) {
        const dmat4 grown = glm::scale(dmat4(1.0), dvec3(1.0 + s));
        return Deformation{{grown, grown}, {3.0 * s}};
    };
    const DeformedMotion motion = compute(shape);
    EXPECT_GT(motion.shape.keys.size(), 4u);
    EXPECT_LE(findLargestDeviation(motion.shape, shape), perspective().of(motion.object.swept));
}

TEST(DeformationKeys, ABoundIsNeverBelowWhatAVertexDoes) {
    const scene::Primitive rod = makeRod();
    const scene::PoseReach reach = scene::computePoseReach({&rod, 1});
    for (int i = 0; i < 200; ++i) {
        const double from = 0.013 * i;
        const Deformation a = deformAt(from, 2.0, 0.7);
        const Deformation b = deformAt(from + 0.2, 2.0, 0.7);
        const double t = std::fmod(0.37 * i, 1.0);
        const Deformation exact = deformAt(from + 0.2 * t, 2.0, 0.7);
        double largest = 0.0;
        for (size_t vertex = 0; vertex < rod.positions.size(); ++vertex)
            largest = std::max(
                largest,
                glm::length(
                    bend(rod, vertex, exact) -
                    glm::mix(bend(rod, vertex, a), bend(rod, vertex, b), t)
                )
            );
        const double bound = measureDeformationDeviation(exact, a, b, t, reach);
        EXPECT_LE(largest, bound * (1.0 + 1e-12));
        EXPECT_LE(bound, 20.0 * largest + 1e-3) << "so loose that it costs keys";
    }
}

TEST(DeformationKeys, SweptBoxesHoldEveryVertexAtEveryTime) {
    const auto shape = [](double s) { return deformAt(s, 4.0, 0.5); };
    const DeformedMotion motion = compute(shape);
    const scene::Primitive rod = makeRod();
    for (int i = 0; i <= 997; ++i)
        for (size_t vertex = 0; vertex < rod.positions.size(); ++vertex) {
            const dvec3 object = bend(rod, vertex, shape(i / 997.0));
            const dvec3 eye(placed(1.0) * dvec4(object, 1.0));
            for (int axis = 0; axis < 3; ++axis) {
                EXPECT_GE(object[axis], motion.shape.swept.min[axis] - 1e-4);
                EXPECT_LE(object[axis], motion.shape.swept.max[axis] + 1e-4);
                EXPECT_GE(eye[axis], motion.object.swept.min[axis] - 1e-4);
                EXPECT_LE(eye[axis], motion.object.swept.max[axis] + 1e-4);
            }
        }
}

TEST(DeformationKeys, AJumpIsDrawnOutOverTheShortestInterval) {
    const auto shape = [](double s) { return Deformation{{}, {s < 0.4 ? 0.0 : 1.0}}; };
    const DeformedMotion motion = compute(shape);
    EXPECT_FALSE(motion.shape.followsExactly);
    EXPECT_EQ(motion.shape.keys.size(), kMaxDeformationIntervals + 1u);
}

TEST(DeformationKeys, AShapeThatIsNowhereForAWhileHasNone) {
    const scene::Primitive rod = makeRod();
    const scene::PoseReach reach = scene::computePoseReach({&rod, 1});
    const auto still = [](double) { return placed(1.0); };
    for (const double bad :
         {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
        const auto weights = [bad](double s) {
            return Deformation{{}, {s > 0.4 && s < 0.6 ? bad : s}};
        };
        EXPECT_FALSE(computeDeformedMotion(still, weights, reach, perspective()));
        const auto joints = [bad](double s) {
            Deformation pose = deformAt(s, 1.0, 0.0);
            if (s > 0.4 && s < 0.6)
                pose.objectFromBind[1][3][0] = bad;
            return pose;
        };
        EXPECT_FALSE(computeDeformedMotion(still, joints, reach, perspective()));
    }
}

} // namespace shutter::extract
