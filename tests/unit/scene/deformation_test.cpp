// SPDX-License-Identifier: MIT
// Skins and morph targets at a time, and the bounds of the deformed meshes.
#include "engine/math/transform.h"
#include "engine/scene/deformation.h"
#include "engine/scene/deformed_bounds.h"
#include "engine/scene/motion.h"
#include "tests/unit/scene/near.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

namespace shutter::scene {
namespace {

using math::Bounds;
using math::dmat4;
using math::dvec3;
using math::dvec4;
using math::vec3;
using math::vec4;

constexpr double kQuarter = std::numbers::pi / 2.0;

/// Up to the rounding of doubles.
void expectSame(const dvec3& actual, const dvec3& expected) {
    expectNear(actual, expected, 1e-12);
}

dvec3 transformPoint(const dmat4& matrix, const dvec3& point) {
    return dvec3(matrix * dvec4(point, 1.0));
}

/// Like SimpleSkin of the sample models: joint 0 at the origin, joint 1 at (0, 1, 0) below it,
/// bound there; joint 1 turns about z by a clip, a quarter turn a second.
class SkinChain : public testing::Test {
  protected:
    SkinChain() {
        mRoot = add({});
        mTip = add({{0.0, 1.0, 0.0}});
        mWorld.registry.add(mTip, Parent{mRoot});
        mBody = add({});
        Skin skin;
        skin.jointFromBind = {dmat4(1.0), glm::translate(dmat4(1.0), dvec3(0.0, -1.0, 0.0))};
        mWorld.assets.skins.push_back(skin);
        mWorld.registry.add(mBody, Skinned{0, {mRoot, mTip}});
    }

    ecs::Entity add(const math::Transform& transform) {
        const ecs::Entity entity = mWorld.registry.create();
        mWorld.registry.add(entity, LocalTransform{transform});
        return entity;
    }

    void turnTip() {
        AnimationChannel channel;
        channel.path = AnimationPath::Rotation;
        channel.times = {0.0f, 1.0f};
        const float half = float(std::sqrt(0.5));
        channel.values = {vec4(0.0f, 0.0f, 0.0f, 1.0f), vec4(0.0f, 0.0f, half, half)};
        AnimationClip clip;
        clip.duration = 1.0;
        clip.channels = {channel};
        mWorld.assets.clips.push_back(clip);
        mWorld.registry.add(mTip, Animated{{{0, 0}}});
    }

    /// Where a vertex is that one joint bends.
    [[nodiscard]] dvec3 pointAt(size_t joint, const dvec3& bind, double seconds) const {
        const Deformation pose = deformationAt(mWorld, mBody, seconds);
        const dmat4 worldFromBind =
            worldFromObject(mWorld, mBody, seconds) * pose.objectFromBind[joint];
        return transformPoint(worldFromBind, bind);
    }

    World mWorld;
    ecs::Entity mRoot, mTip, mBody;
};

TEST_F(SkinChain, TheBindPoseMovesNothingAndASkinBendsAboutItsJoint) {
    EXPECT_TRUE(isDeformable(mWorld, mBody));
    EXPECT_FALSE(mayDeform(mWorld, mBody));
    EXPECT_FALSE(mayObjectMove(mWorld, mBody));
    const Deformation pose = deformationAt(mWorld, mBody, 3.0);
    ASSERT_EQ(pose.objectFromBind.size(), 2u);
    EXPECT_EQ(pose.objectFromBind[0], dmat4(1.0));
    EXPECT_EQ(pose.objectFromBind[1], dmat4(1.0));
    EXPECT_TRUE(pose.morphWeights.empty());
    turnTip();
    EXPECT_TRUE(mayDeform(mWorld, mBody));
    EXPECT_FALSE(mayObjectMove(mWorld, mBody)) << "the first joint stands";
    for (const double seconds : {0.0, 0.25, 0.5, 1.0}) {
        const double angle = kQuarter * seconds;
        expectSame(pointAt(0, {0.5, 2.0, 0.0}, seconds), {0.5, 2.0, 0.0});
        // (0, 1) above the joint, turned; slerp keeps the angle in step with time.
        expectNear(
            pointAt(1, {0.0, 2.0, 0.0}, seconds),
            {-std::sin(angle), 1.0 + std::cos(angle), 0.0},
            1e-7
        );
    }
}

TEST_F(SkinChain, ASkinFollowsItsJointsAndNotItsOwnTransform) {
    mWorld.registry.add(mBody, LocalTransform{{dvec3(100.0), {1.0, 0.0, 0.0, 0.0}, dvec3(7.0)}});
    mWorld.registry.add(mBody, LinearVelocity{dvec3(50.0)});
    EXPECT_FALSE(mayObjectMove(mWorld, mBody));
    expectSame(pointAt(1, {0.0, 2.0, 0.0}, 1.0), {0.0, 2.0, 0.0});
    mWorld.registry.add(mRoot, LinearVelocity{{3.0, 0.0, 0.0}});
    EXPECT_TRUE(mayObjectMove(mWorld, mBody));
    expectSame(pointAt(1, {0.0, 2.0, 0.0}, 2.0), {6.0, 2.0, 0.0});
}

TEST_F(SkinChain, TheOriginIsAtTheFirstJointWithWorldAxesUnlessThatIsNowhere) {
    mWorld.registry.add(
        mRoot, LocalTransform{{dvec3(5.0, 6.0, 7.0), glm::angleAxis(1.0, kUnitZ), dvec3(2.0)}}
    );
    const dmat4 expected = glm::translate(dmat4(1.0), dvec3(5.0, 6.0, 7.0));
    EXPECT_EQ(worldFromObject(mWorld, mBody, 0.0), expected);
    mWorld.registry.add(mRoot, LocalTransform{});
    mWorld.registry.add(mBody, Skinned{0, {add({dvec3(kNan, 0.0, 0.0)}), mTip}});
    expectSame(pointAt(1, {0.0, 1.0, 0.0}, 0.0), {0.0, 1.0, 0.0});
    mWorld.registry.remove<Skinned>(mBody);
    EXPECT_EQ(worldFromObject(mWorld, mBody, 0.0), dmat4(1.0)) << "its own transform counts again";
}

TEST_F(SkinChain, ASkinsNumbersStaySmallFarFromTheOrigin) {
    turnTip();
    const Deformation near = deformationAt(mWorld, mBody, 0.4);
    mWorld.registry.add(mRoot, LocalTransform{{dvec3(1e6, -1e6, 1e6)}});
    const Deformation far = deformationAt(mWorld, mBody, 0.4);
    // Doubles near 1e6 are 1.2e-10 apart; floats 0.06.
    for (size_t joint = 0; joint < 2; ++joint)
        expectNear(far.objectFromBind[joint], near.objectFromBind[joint], 1e-9);
}

WeightChannel makeChannel(Interpolation interpolation) {
    WeightChannel channel;
    channel.interpolation = interpolation;
    channel.targetCount = 2;
    channel.times = {1.0f, 3.0f};
    channel.values = {0.0f, 10.0f, 1.0f, -10.0f};
    return channel;
}

std::vector<double> pair(double a, double b) {
    return {a, b};
}

TEST(SampleWeights, LinearMixesAllTargetsStepHoldsTheKeyBeforeAndBothHoldTheEnds) {
    EXPECT_EQ(sampleWeights(makeChannel(Interpolation::Linear), 1.5), pair(0.25, 5.0));
    EXPECT_EQ(sampleWeights(makeChannel(Interpolation::Linear), 2.0), pair(0.5, 0.0));
    EXPECT_EQ(sampleWeights(makeChannel(Interpolation::Step), 2.999), pair(0.0, 10.0));
    for (const Interpolation interpolation : {Interpolation::Step, Interpolation::Linear}) {
        WeightChannel channel = makeChannel(interpolation);
        for (const double seconds : {0.0, 1.0, kNan})
            EXPECT_EQ(sampleWeights(channel, seconds), pair(0.0, 10.0));
        for (const double seconds : {3.0, 99.0})
            EXPECT_EQ(sampleWeights(channel, seconds), pair(1.0, -10.0));
        channel.times = {1.0f}; // a single key holds for ever
        channel.values = {3.0f, 4.0f};
        for (const double seconds : {-1e9, 1.0, 1e9})
            EXPECT_EQ(sampleWeights(channel, seconds), pair(3.0, 4.0));
    }
}

TEST(SampleWeights, CubicSplineFollowsItsTangents) {
    WeightChannel channel = makeChannel(Interpolation::CubicSpline);
    // In-tangents, values, out-tangents of both targets, a key after the other. Per second; the
    // interval has two.
    channel.values = {9, 9, 0, 1, 0.5f, 0, 0.5f, 2, 1, 1, 9, 9};
    EXPECT_EQ(sampleWeights(channel, 1.0), pair(0.0, 1.0));
    EXPECT_EQ(sampleWeights(channel, 3.0), pair(1.0, 1.0));
    // The first is the straight line; the second at half time 1 - in-tangent * 2 / 8.
    const std::vector<double> middle = sampleWeights(channel, 2.0);
    EXPECT_NEAR(middle[0], 0.5, 1e-12);
    EXPECT_NEAR(middle[1], 0.5, 1e-12);
    EXPECT_NEAR(sampleWeights(channel, 1.5)[0], 0.25, 1e-12);
}

/// One entity, two targets, clips that hold 1, 2, ... of all targets after their first second.
class Morphed : public testing::Test {
  protected:
    Morphed() {
        mEntity = mWorld.registry.create();
        mWorld.registry.add(mEntity, MorphWeights{{0.25f, -0.5f}, {}});
    }

    void addClip() {
        const float height = float(mWorld.assets.clips.size()) + 1.0f;
        WeightChannel channel;
        channel.targetCount = 2;
        channel.times = {0.0f, 1.0f, 2.0f};
        channel.values = {0.0f, 0.0f, height, height, height, height};
        AnimationClip clip;
        clip.duration = 2.0;
        clip.weightChannels = {channel};
        mWorld.assets.clips.push_back(clip);
        mWorld.playback.activeClips.push_back(true);
        const auto index = static_cast<uint32_t>(mWorld.assets.clips.size() - 1);
        mWorld.registry.get<MorphWeights>(mEntity).channels.push_back({index, 0});
    }

    [[nodiscard]] std::vector<double> weightsAt(double seconds) const {
        return deformationAt(mWorld, mEntity, seconds).morphWeights;
    }

    World mWorld;
    ecs::Entity mEntity;
};

TEST_F(Morphed, TheLatestActiveClipWinsInWhateverOrderAndHoldsItsEndOrStartsAgain) {
    addClip();
    addClip();
    addClip();
    auto& channels = mWorld.registry.get<MorphWeights>(mEntity).channels;
    std::swap(channels[1], channels[2]);
    EXPECT_TRUE(mayDeform(mWorld, mEntity));
    EXPECT_EQ(weightsAt(1.0), pair(3.0, 3.0));
    mWorld.playback.activeClips[2] = false;
    EXPECT_EQ(weightsAt(1.0), pair(2.0, 2.0));
    EXPECT_EQ(weightsAt(2.5), pair(2.0, 2.0));
    mWorld.playback.loop = true;
    EXPECT_EQ(weightsAt(2.5), pair(1.0, 1.0));
    EXPECT_EQ(weightsAt(-1.5), pair(1.0, 1.0));
    mWorld.playback.activeClips = {false, false, false};
    EXPECT_EQ(weightsAt(1.0), pair(0.25, -0.5));
    EXPECT_FALSE(mayDeform(mWorld, mEntity));
    mWorld.playback.activeClips = {true, true, true};
    mWorld.assets.clips[2].weightChannels[0].targetCount = 1;
    EXPECT_DEATH((void)weightsAt(0.0), "targetCount") << "weights of another count";
}

class Waving : public testing::Test {
  protected:
    Waving() {
        mEntity = mWorld.registry.create();
        mWorld.registry.add(
            mEntity,
            LocalTransform{{{3.0, 0.0, 0.0}, glm::angleAxis(1.1, dvec3(0, 1, 0)), dvec3(2.0)}}
        );
        mWaves.waves = {{{0.3, 0.1, 0.0}, {1.5, 0.0, 0.4}, 2.0, 0.7}};
    }

    [[nodiscard]] WavePose poseAt(double seconds) {
        mWorld.registry.remove<VertexWaves>(mEntity);
        mWorld.registry.add(mEntity, mWaves);
        return deformationAt(mWorld, mEntity, seconds).waves;
    }

    World mWorld;
    ecs::Entity mEntity;
    VertexWaves mWaves;
};

TEST_F(Waving, AWaveRunsByItsFrequencyAndALeanIsConstant) {
    mWaves.lean = {0.0, 0.0, 0.5};
    for (const double seconds : {-1.3, 0.0, 0.2, 7.0}) {
        const WavePose pose = poseAt(seconds);
        ASSERT_EQ(pose.waves.size(), 2u);
        EXPECT_EQ(std::sin(pose.waves[0].phase), 1.0);
        EXPECT_EQ(pose.waves[0].displacement, mWaves.lean);
        EXPECT_NEAR(
            std::sin(pose.waves[1].phase), std::sin(4.0 * std::numbers::pi * seconds + 0.7), 1e-12
        );
    }
    const double year = 365.0 * 86400.0;
    EXPECT_NEAR(poseAt(year + 0.125).waves[1].phase, poseAt(0.125).waves[1].phase, 1e-6);
    EXPECT_TRUE(isDeformable(mWorld, mEntity));
    EXPECT_TRUE(mayDeform(mWorld, mEntity));
    EXPECT_FALSE(mayObjectMove(mWorld, mEntity));
}

TEST_F(Waving, WorldWavesAreIndependentOfTheEntitysPlacement) {
    mWaves.inWorld = true;
    const double seconds = 0.3;
    const WavePose pose = poseAt(seconds);
    const dmat4 world = worldFromEntity(mWorld, mEntity, seconds);
    const dvec3 point(0.4, -0.2, 0.9);
    const WavePose::Wave& one = pose.waves.at(0);
    const dvec3 moved = dvec3(
        world * dvec4(std::sin(one.phase - glm::dot(one.waveVector, point)) * one.displacement, 0.0)
    );
    const dvec3 place = transformPoint(world, point);
    const double phase =
        4.0 * std::numbers::pi * seconds + 0.7 - glm::dot(mWaves.waves[0].waveVector, place);
    expectSame(moved, std::sin(phase) * mWaves.waves[0].displacement);
}

TEST_F(Waving, StaticWorldWavesDeformAMovingEntityAndMoveNoFlattenedOne) {
    mWaves.waves[0].hertz = 0.0;
    (void)poseAt(0.0);
    mWorld.registry.add(mEntity, LinearVelocity{{1, 0, 0}});
    EXPECT_FALSE(mayDeform(mWorld, mEntity));
    mWaves.inWorld = true;
    (void)poseAt(0.0);
    EXPECT_TRUE(mayDeform(mWorld, mEntity));
    mWorld.registry.get<LocalTransform>(mEntity).transform.scale = {1.0, 0.0, 1.0};
    const WavePose pose = poseAt(0.3);
    EXPECT_EQ(pose.waves.at(0).displacement, dvec3(0.0));
    EXPECT_TRUE(isFinite(pose));
}

TEST_F(Waving, InvalidWavesAreRefusedByName) {
    const auto expectNamed = [&](const char* part, auto change) {
        VertexWaves changed = mWaves;
        changed.share = WaveShare::Height;
        EXPECT_TRUE(validateWaves(changed).ok());
        change(changed);
        const core::Status status = validateWaves(changed);
        ASSERT_FALSE(status.ok()) << part;
        EXPECT_NE(status.error().message.find(part), std::string::npos) << status.error().message;
    };
    expectNamed("17 waves", [](VertexWaves& w) { w.waves.resize(17); });
    expectNamed("lean", [](VertexWaves& w) { w.lean.y = kNan; });
    expectNamed("waves[0].displacement", [](VertexWaves& w) { w.waves[0].displacement.z = 2e6; });
    expectNamed("waves[0].waveVector", [](VertexWaves& w) { w.waves[0].waveVector.x = kNan; });
    expectNamed("waves[0].hertz", [](VertexWaves& w) { w.waves[0].hertz = -1.0; });
    expectNamed("waves[0].phase", [](VertexWaves& w) { w.waves[0].phase = kNan; });
    expectNamed("exponent", [](VertexWaves& w) { w.exponent = 0.5; });
    expectNamed("axis", [](VertexWaves& w) { w.axis = dvec3(0.0); });
    expectNamed("held at", [](VertexWaves& w) { w.freeAt = w.heldAt; });
    expectNamed("channel", [](VertexWaves& w) {
        w.share = WaveShare::Color;
        w.channel = 4;
    });
}

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

WavePose drawWaves(Random& random) {
    WavePose pose;
    pose.shares.share = WaveShare::Height;
    pose.shares.height = dvec4(drawVec3(random, 1.0), draw(random, -1.0, 1.0));
    pose.shares.exponent = draw(random, 1.0, 4.0);
    for (int i = 0; i < 3; ++i)
        pose.waves.push_back({drawVec3(random, 2.0), drawVec3(random, 3.0), draw(random, -3.0, 3.0)}
        );
    return pose;
}

/// VertexWaves, written out for a share of height.
dvec3 wave(const dvec3& position, const WavePose& pose) {
    const double height = glm::dot(dvec3(pose.shares.height), position) + pose.shares.height.w;
    const double share = std::pow(std::clamp(height, 0.0, 1.0), pose.shares.exponent);
    dvec3 displaced = position;
    for (const WavePose::Wave& one : pose.waves)
        displaced +=
            share * std::sin(one.phase - glm::dot(one.waveVector, position)) * one.displacement;
    return displaced;
}

Deformation drawPose(Random& random, bool isSkinned, bool isMorphed, bool isWaving) {
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
    if (isWaving)
        pose.waves = drawWaves(random);
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
    morphed = wave(morphed, pose.waves);
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

TEST(DeformedBounds, BoundsContainEveryVertexOfRandomPoses) {
    Random random(1);
    const std::vector<Primitive> primitives = {makePrimitive(random, 20), makePrimitive(random, 3)};
    const PoseReach reach = computePoseReach(primitives);
    for (int i = 0; i < 200; ++i) {
        for (const bool isSkinned : {false, true}) {
            const Deformation pose = drawPose(random, isSkinned, i % 2 == 0, i % 3 == 0);
            const Bounds bounds = computeDeformedBounds(reach, pose);
            for (const Primitive& primitive : primitives) {
                for (size_t v = 0; v < primitive.positions.size(); ++v)
                    expectHolds(bounds, deform(primitive, v, pose));
            }
        }
    }
}

TEST(DeformedBounds, BoundsWithoutADeformationAreTheRestBoundsAndWithoutVerticesThereAreNone) {
    Random random(2);
    const Primitive primitive = makePrimitive(random, 10);
    const PoseReach reach = computePoseReach({&primitive, 1});
    Bounds rest;
    for (const vec3& position : primitive.positions)
        rest.add(dvec3(position));
    for (const Bounds& bounds : {computeDeformedBounds(reach, {}), reach.rest}) {
        EXPECT_EQ(bounds.min, rest.min);
        EXPECT_EQ(bounds.max, rest.max);
    }
    EXPECT_TRUE(computeDeformedBounds(computePoseReach({}), {}).isEmpty());
    EXPECT_TRUE(computeDeformedBounds(computePoseReach({}), {{dmat4(1.0)}, {0.5}}).isEmpty());
}

/// Two vertices, one per joint, the second also with a target.
Primitive makeTwoPoints() {
    Primitive primitive;
    primitive.positions = {vec3(0.0f), vec3(1.0f, 0.0f, 0.0f)};
    primitive.influenceCount = 4;
    primitive.joints = {0, 1, 0, 0, 1, 0, 0, 0};
    primitive.weights = {1.0f, 0.0f, 0.0f, 0.0f, 1.0f, 0.0f, 0.0f, 0.0f};
    primitive.morphTargets = {{{vec3(0.0f), vec3(0.0f, 2.0f, 0.0f)}, {}, {}}};
    return primitive;
}

class TwoPoints : public testing::Test {
  protected:
    [[nodiscard]] Bounds boundsOf(const Deformation& pose) const {
        return computeDeformedBounds(computePoseReach({&mPrimitive, 1}), pose);
    }

    Primitive mPrimitive = makeTwoPoints();
};

TEST_F(TwoPoints, AJointMovesOnlyTheVerticesThatItBends) {
    const PoseReach reach = computePoseReach({&mPrimitive, 1});
    ASSERT_EQ(reach.joints.size(), 2u);
    EXPECT_EQ(reach.joints[1].min, dvec3(1.0, 0.0, 0.0)) << "weight 0 does not bend";
    const dmat4 away = glm::translate(dmat4(1.0), dvec3(100.0, 0.0, 0.0));
    const Bounds bounds = boundsOf({{dmat4(1.0), away}, {}});
    EXPECT_NEAR(bounds.min.x, 0.0, 1e-3);
    EXPECT_NEAR(bounds.max.x, 101.0, 1e-3);
    EXPECT_EQ(bounds.max.y, 0.0);
    EXPECT_DEATH((void)boundsOf({{dmat4(1.0)}, {}}), "joint 1 of 1");
    mPrimitive.influenceCount = 0; // it follows the first joint
    mPrimitive.joints.clear();
    mPrimitive.weights.clear();
    EXPECT_NEAR(boundsOf({{away, dmat4(1.0)}, {}}).min.x, 100.0, 1e-3);
}

TEST_F(TwoPoints, WeightsBelowZeroAndAboveOneReachAsFarAsTheyMove) {
    EXPECT_NEAR(boundsOf({{}, {3.0}}).max.y, 6.0, 1e-4);
    EXPECT_NEAR(boundsOf({{}, {-1.0}}).min.y, -2.0, 1e-4);
    mPrimitive.morphTargets[0].positions.clear();
    EXPECT_EQ(boundsOf({{}, {1.0}}).max.y, 0.0) << "a target without positions";
}

TEST(DeformedBounds, BoundsContainVerticesWhoseRoundedWeightsExceedOne) {
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

TEST_F(TwoPoints, NonFiniteVerticesAreNotIncluded) {
    for (const double bad : {kNan, kInfinity}) {
        dmat4 nowhere(1.0);
        nowhere[3][1] = bad;
        const Bounds bounds = boundsOf({{dmat4(1.0), nowhere}, {}});
        EXPECT_EQ(bounds.min, dvec3(0.0));
        EXPECT_EQ(bounds.max, dvec3(0.0));
        EXPECT_TRUE(boundsOf({{nowhere, nowhere}, {}}).isEmpty());
        EXPECT_TRUE(boundsOf({{}, {bad}}).isEmpty());
    }
}

} // namespace
} // namespace shutter::scene
