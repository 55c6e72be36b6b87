// SPDX-License-Identifier: MIT
#include "engine/math/transform.h"
#include "engine/scene/deformed_bounds.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace shutter::scene {
namespace {

using math::Bounds;
using math::dmat4;
using math::dvec3;
using math::dvec4;
using math::vec3;

constexpr size_t kJointCount = 5;
constexpr size_t kTargetCount = 3;

using Random = std::mt19937;

double draw(Random& random, double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
}

dvec3 drawVec3(Random& random, double size) {
    return {draw(random, -size, size), draw(random, -size, size), draw(random, -size, size)};
}

/// Four joints a vertex, weights as a loader leaves them.
Primitive makePrimitive(Random& random, size_t vertexCount) {
    Primitive primitive;
    primitive.influenceCount = 4;
    primitive.morphTargets.resize(kTargetCount);
    for (size_t v = 0; v < vertexCount; ++v) {
        primitive.positions.emplace_back(drawVec3(random, 2.0));
        double weights[4];
        double sum = 0.0;
        for (double& weight : weights)
            sum += weight = draw(random, 0.0, 1.0);
        for (const double weight : weights) {
            primitive.weights.push_back(float(weight / sum));
            primitive.joints.push_back(uint16_t(random() % kJointCount));
        }
        for (MorphTarget& target : primitive.morphTargets)
            target.positions.emplace_back(drawVec3(random, 0.5));
    }
    return primitive;
}

Deformation drawPose(Random& random, bool isSkinned, bool isMorphed) {
    Deformation pose;
    for (size_t i = 0; isSkinned && i < kJointCount; ++i) {
        const dvec3 axis = glm::normalize(drawVec3(random, 1.0) + dvec3(0.0, 2.0, 0.0));
        pose.objectFromBind.push_back(math::computeMatrix(
            {drawVec3(random, 5.0),
             glm::angleAxis(draw(random, -3.0, 3.0), axis),
             drawVec3(random, 2.0)}
        ));
    }
    for (size_t i = 0; isMorphed && i < kTargetCount; ++i)
        pose.morphWeights.push_back(draw(random, -2.0, 2.0));
    return pose;
}

/// glTF 2.0, 3.7.2.2 and 3.7.3.3, written out.
dvec3 deform(const Primitive& primitive, size_t vertex, const Deformation& pose) {
    dvec3 morphed(primitive.positions[vertex]);
    for (size_t t = 0; t < pose.morphWeights.size(); ++t) {
        const std::vector<vec3>& deltas = primitive.morphTargets[t].positions;
        if (!deltas.empty())
            morphed += pose.morphWeights[t] * dvec3(deltas[vertex]);
    }
    if (pose.objectFromBind.empty())
        return morphed;
    dvec3 skinned(0.0);
    for (size_t i = vertex * 4; i < vertex * 4 + 4; ++i) {
        const dmat4& matrix = pose.objectFromBind[primitive.joints[i]];
        skinned += double(primitive.weights[i]) * dvec3(matrix * dvec4(morphed, 1.0));
    }
    return skinned;
}

void expectHolds(const Bounds& bounds, const dvec3& point) {
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_LE(bounds.min[axis], point[axis]);
        EXPECT_GE(bounds.max[axis], point[axis]);
    }
}

TEST(DeformedBounds, HoldEveryVertexOfRandomPoses) {
    Random random(1);
    const std::vector<Primitive> primitives = {makePrimitive(random, 20), makePrimitive(random, 3)};
    const PoseReach reach = computePoseReach(primitives);
    for (int i = 0; i < 200; ++i) {
        for (const bool isSkinned : {false, true}) {
            const Deformation pose = drawPose(random, isSkinned, i % 2 == 0);
            const Bounds bounds = computeDeformedBounds(reach, pose);
            for (const Primitive& primitive : primitives) {
                for (size_t v = 0; v < primitive.positions.size(); ++v)
                    expectHolds(bounds, deform(primitive, v, pose));
            }
        }
    }
}

TEST(DeformedBounds, WithoutADeformationAreTheRestBounds) {
    Random random(2);
    const Primitive primitive = makePrimitive(random, 10);
    const PoseReach reach = computePoseReach({&primitive, 1});
    const Bounds bounds = computeDeformedBounds(reach, {});
    EXPECT_EQ(bounds.min, reach.rest.min);
    EXPECT_EQ(bounds.max, reach.rest.max);
    Bounds rest;
    for (const vec3& position : primitive.positions)
        rest.add(dvec3(position));
    EXPECT_EQ(bounds.min, rest.min);
    EXPECT_EQ(bounds.max, rest.max);
}

/// Two vertices, one a joint, the second also a target.
Primitive makeTwoPoints() {
    Primitive primitive;
    primitive.positions = {vec3(0.0f), vec3(1.0f, 0.0f, 0.0f)};
    primitive.influenceCount = 4;
    primitive.joints = {0, 1, 0, 0, 1, 0, 0, 0};
    primitive.weights = {1.0f, 0.0f, 0.0f, 0.0f, 1.0f, 0.0f, 0.0f, 0.0f};
    primitive.morphTargets = {{{vec3(0.0f), vec3(0.0f, 2.0f, 0.0f)}, {}, {}}};
    return primitive;
}

TEST(DeformedBounds, AJointMovesOnlyTheVerticesThatItBends) {
    const Primitive primitive = makeTwoPoints();
    const PoseReach reach = computePoseReach({&primitive, 1});
    ASSERT_EQ(reach.joints.size(), 2u);
    EXPECT_EQ(reach.joints[1].min, dvec3(1.0, 0.0, 0.0)) << "weight 0 does not bend";
    const dmat4 away = glm::translate(dmat4(1.0), dvec3(100.0, 0.0, 0.0));
    const Bounds bounds = computeDeformedBounds(reach, {{dmat4(1.0), away}, {}});
    EXPECT_NEAR(bounds.min.x, 0.0, 1e-3);
    EXPECT_NEAR(bounds.max.x, 101.0, 1e-3);
    EXPECT_EQ(bounds.max.y, 0.0);
}

TEST(DeformedBounds, WeightsBelowZeroAndAboveOneReachAsFarAsTheyMove) {
    const Primitive primitive = makeTwoPoints();
    const PoseReach reach = computePoseReach({&primitive, 1});
    EXPECT_NEAR(computeDeformedBounds(reach, {{}, {3.0}}).max.y, 6.0, 1e-4);
    EXPECT_NEAR(computeDeformedBounds(reach, {{}, {-1.0}}).min.y, -2.0, 1e-4);
}

TEST(DeformedBounds, HoldVerticesWhoseRoundedWeightsSumToMoreThanOne) {
    Primitive primitive;
    primitive.positions = {vec3(1.0f)};
    primitive.influenceCount = 4;
    primitive.joints = {0, 1, 0, 0};
    const float half = std::nextafter(0.5f, 1.0f);
    primitive.weights = {half, half, 0.0f, 0.0f};
    const dmat4 away = glm::translate(dmat4(1.0), dvec3(1e4));
    const Deformation pose{{away, away}, {}};
    expectHolds(
        computeDeformedBounds(computePoseReach({&primitive, 1}), pose), deform(primitive, 0, pose)
    );
}

TEST(DeformedBounds, AMeshWithoutVerticesHasNone) {
    const PoseReach reach = computePoseReach({});
    EXPECT_TRUE(computeDeformedBounds(reach, {}).isEmpty());
    EXPECT_TRUE(computeDeformedBounds(reach, {{dmat4(1.0)}, {0.5}}).isEmpty());
}

TEST(DeformedBounds, APrimitiveWithoutInfluencesFollowsTheFirstJoint) {
    Primitive primitive = makeTwoPoints();
    primitive.influenceCount = 0;
    primitive.joints.clear();
    primitive.weights.clear();
    const dmat4 up = glm::translate(dmat4(1.0), dvec3(0.0, 5.0, 0.0));
    const PoseReach reach = computePoseReach({&primitive, 1});
    EXPECT_NEAR(computeDeformedBounds(reach, {{up, dmat4(1.0)}, {}}).min.y, 5.0, 1e-4);
}

TEST(DeformedBounds, ATargetWithoutPositionsMovesNothing) {
    Primitive primitive = makeTwoPoints();
    primitive.morphTargets[0].positions.clear();
    const PoseReach reach = computePoseReach({&primitive, 1});
    EXPECT_EQ(computeDeformedBounds(reach, {{}, {1.0}}).max.y, 0.0);
}

TEST(DeformedBounds, WhatIsNowhereIsNotHeld) {
    const Primitive primitive = makeTwoPoints();
    const PoseReach reach = computePoseReach({&primitive, 1});
    for (const double bad :
         {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
        dmat4 nowhere(1.0);
        nowhere[3][1] = bad;
        const Bounds bounds = computeDeformedBounds(reach, {{dmat4(1.0), nowhere}, {}});
        EXPECT_EQ(bounds.min, dvec3(0.0));
        EXPECT_EQ(bounds.max, dvec3(0.0));
        EXPECT_TRUE(computeDeformedBounds(reach, {{nowhere, nowhere}, {}}).isEmpty());
        EXPECT_TRUE(computeDeformedBounds(reach, {{}, {bad}}).isEmpty());
    }
}

TEST(DeformedBoundsDeathTest, AJointPastThePoseIsAProgrammersMistake) {
    const Primitive primitive = makeTwoPoints();
    const PoseReach reach = computePoseReach({&primitive, 1});
    EXPECT_DEATH((void)computeDeformedBounds(reach, {{dmat4(1.0)}, {}}), "joint 1 of 1");
}

} // namespace
} // namespace shutter::scene
