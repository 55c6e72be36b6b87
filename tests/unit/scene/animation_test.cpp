// SPDX-License-Identifier: MIT
// Clips: the pose at a time, and when they may jump.
#include "engine/scene/animation.h"
#include "engine/scene/clip_jumps.h"
#include "engine/scene/motion.h"
#include "tests/unit/scene/near.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace shutter::scene {
namespace {

using math::dvec3;
using math::dvec4;
using math::vec4;

constexpr double kTolerance = 1e-6; // keys are single precision

void expectNearKey(const dvec4& actual, const dvec4& expected) {
    for (int i = 0; i < 4; ++i)
        EXPECT_NEAR(actual[i], expected[i], kTolerance) << "component " << i;
}

/// Rotation about z as glTF stores it.
vec4 turnZ(double degrees) {
    const double half = degrees * std::numbers::pi / 360.0;
    return vec4(dvec4(0.0, 0.0, std::sin(half), std::cos(half)));
}

AnimationChannel makeMove(Interpolation interpolation) {
    AnimationChannel channel;
    channel.interpolation = interpolation;
    channel.times = {1.0f, 2.0f, 4.0f};
    channel.values = {vec4(0.0f), vec4(10.0f, 0.0f, 0.0f, 0.0f), vec4(10.0f, 8.0f, 0.0f, 0.0f)};
    return channel;
}

AnimationChannel makeTurn(const vec4& from, const vec4& to) {
    AnimationChannel channel;
    channel.path = AnimationPath::Rotation;
    channel.times = {0.0f, 1.0f};
    channel.values = {from, to};
    return channel;
}

TEST(SampleChannel, LinearMixesTheKeysAroundTheTimeAndStepHoldsTheLastUntilTheNext) {
    const AnimationChannel linear = makeMove(Interpolation::Linear);
    EXPECT_EQ(sampleChannel(linear, 2.0), dvec4(linear.values[1]));
    expectNearKey(sampleChannel(linear, 1.25), {2.5, 0.0, 0.0, 0.0});
    expectNearKey(sampleChannel(linear, 3.5), {10.0, 6.0, 0.0, 0.0});
    const AnimationChannel step = makeMove(Interpolation::Step);
    expectNearKey(sampleChannel(step, 1.999), {0.0, 0.0, 0.0, 0.0});
    expectNearKey(sampleChannel(step, 2.0), {10.0, 0.0, 0.0, 0.0});
    expectNearKey(sampleChannel(step, 3.999), {10.0, 0.0, 0.0, 0.0});
    expectNearKey(sampleChannel(step, 4.0), {10.0, 8.0, 0.0, 0.0});
}

TEST(SampleChannel, TimesOutsideTheKeysAreClampedAndASingleKeyHoldsForEver) {
    const AnimationChannel move = makeMove(Interpolation::Linear);
    AnimationChannel single;
    single.times = {3.0f};
    single.values = {vec4(1.0f, 2.0f, 3.0f, 0.0f)};
    AnimationChannel cubic = single;
    cubic.interpolation = Interpolation::CubicSpline;
    cubic.values = {vec4(7.0f), single.values[0], vec4(8.0f)};
    for (const double seconds : {0.0, -5.0, -kInfinity, kNan, 3.0, 4.5, 1e300, kInfinity}) {
        if (seconds != 3.0) {
            const bool isAfter = seconds > 3.0;
            EXPECT_EQ(sampleChannel(move, seconds), double(isAfter) * dvec4(10.0, 8.0, 0.0, 0.0));
        }
        EXPECT_EQ(sampleChannel(single, seconds), dvec4(1.0, 2.0, 3.0, 0.0)) << seconds;
        EXPECT_EQ(sampleChannel(cubic, seconds), dvec4(1.0, 2.0, 3.0, 0.0)) << seconds;
    }
}

TEST(SampleChannel, CubicSplineScalesTangentsByTheKeyInterval) {
    AnimationChannel channel;
    channel.interpolation = Interpolation::CubicSpline;
    channel.times = {1.0f, 3.0f};
    channel.values = {
        vec4(99.0f),
        vec4(1.0f),
        vec4(4.0f), // in-tangent (unused), value, out-tangent
        vec4(-2.0f),
        vec4(5.0f),
        vec4(99.0f), // in-tangent, value, out-tangent (unused)
    };
    // s = 1/4, interval 2: h00 = 27/32, h10 = 9/64, h01 = 5/32, h11 = -3/64, so
    // 27/32 * 1 + 9/64 * 2 * 4 + 5/32 * 5 - 3/64 * 2 * -2 = 0.84375 + 1.125 + 0.78125 + 0.1875.
    expectNearKey(sampleChannel(channel, 1.5), dvec4(2.9375));
    expectNearKey(sampleChannel(channel, 1.0), dvec4(1.0));
    expectNearKey(sampleChannel(channel, 3.0), dvec4(5.0));
    expectNearKey(sampleChannel(channel, 0.0), dvec4(1.0));
    expectNearKey(sampleChannel(channel, 9.0), dvec4(5.0));
}

TEST(SampleChannel, CubicSplineRotationsHaveUnitLength) {
    AnimationChannel channel = makeTurn(turnZ(0), turnZ(90));
    channel.interpolation = Interpolation::CubicSpline;
    channel.values = {vec4(0.0f), turnZ(0), vec4(0.0f), vec4(0.0f), turnZ(90), vec4(0.0f)};
    // Without tangents the middle is the mean of the two, 45 degrees once normalised.
    expectNearKey(sampleChannel(channel, 0.5), dvec4(turnZ(45)));
    EXPECT_NEAR(glm::length(sampleChannel(channel, 0.3)), 1.0, 1e-12);
}

TEST(SampleChannel, LinearRotationsTurnAtConstantSpeedByTheShorterArc) {
    const AnimationChannel channel = makeTurn(turnZ(0), turnZ(120));
    expectNearKey(sampleChannel(channel, 0.25), dvec4(turnZ(30)));
    expectNearKey(sampleChannel(channel, 0.75), dvec4(turnZ(90)));
    expectNearKey(sampleChannel(makeTurn(turnZ(33), turnZ(33)), 0.4), dvec4(turnZ(33)));
    const dvec4 flipped = sampleChannel(makeTurn(turnZ(10), -turnZ(50)), 0.5);
    EXPECT_NEAR(std::abs(glm::dot(flipped, dvec4(turnZ(30)))), 1.0, kTolerance);
    // 200 degrees one way are 160 the other.
    const dvec4 back = sampleChannel(makeTurn(turnZ(0), turnZ(200)), 0.5);
    EXPECT_NEAR(std::abs(glm::dot(back, dvec4(turnZ(-80)))), 1.0, kTolerance);
}

TEST(SampleChannel, RotationKeysAreNormalisedAndZeroIsTheIdentity) {
    const AnimationChannel doubled = makeTurn(2.0f * turnZ(0), 3.0f * turnZ(90));
    expectNearKey(sampleChannel(doubled, 0.0), dvec4(turnZ(0)));
    expectNearKey(sampleChannel(doubled, 0.5), dvec4(turnZ(45)));
    expectNearKey(sampleChannel(doubled, 1.0), dvec4(turnZ(90)));
    expectNearKey(sampleChannel(makeTurn(vec4(0.0f), vec4(0.0f)), 0.5), {0.0, 0.0, 0.0, 1.0});
}

TEST(SampleChannelDeathTest, AChannelWithoutKeysOrWithMissingValuesIsRefused) {
    AnimationChannel channel;
    channel.node = 12;
    EXPECT_DEATH((void)sampleChannel(channel, 0.0), "node 12 has no keys");
    channel = makeMove(Interpolation::Linear);
    channel.values.pop_back();
    EXPECT_DEATH((void)sampleChannel(channel, 0.0), "2 and 3");
    channel = makeMove(Interpolation::CubicSpline);
    EXPECT_DEATH((void)sampleChannel(channel, 0.0), "3 and 9");
}

/// Two clips that move along x: the first from 0 to 4 in 4 s, the second from 100 to 102 in 2 s;
/// the second also scales to 3.
class SampleAnimated : public testing::Test {
  protected:
    SampleAnimated() {
        mAssets.clips.resize(2);
        mAssets.clips[0] = {"walk", 4.0, {makeRamp(0.0f, 4.0f, 4.0f)}};
        AnimationChannel scale = makeRamp(3.0f, 3.0f, 2.0f);
        scale.path = AnimationPath::Scale;
        mAssets.clips[1] = {"fly", 2.0, {makeRamp(100.0f, 102.0f, 2.0f), scale}};
        mPlayback.activeClips = {true, true};
        mRest.translation = {-1.0, -2.0, -3.0};
    }

    static AnimationChannel makeRamp(float from, float to, float end) {
        AnimationChannel channel;
        channel.times = {0.0f, end};
        channel.values = {vec4(from), vec4(to)};
        return channel;
    }

    [[nodiscard]] double sampleX(double seconds) const {
        return sampleAnimated(mAssets, mPlayback, mAnimated, mRest, seconds).translation.x;
    }

    Assets mAssets;
    Playback mPlayback;
    Animated mAnimated;
    math::Transform mRest;
};

TEST_F(SampleAnimated, TheLatestActiveClipWinsInWhateverOrderTheyAreListed) {
    mAnimated.channels = {{1, 0}, {0, 0}};
    EXPECT_EQ(sampleX(1.0), 101.0);
    mAnimated.channels = {{0, 0}, {1, 0}};
    EXPECT_EQ(sampleX(1.0), 101.0);
    mPlayback.activeClips = {true, false};
    EXPECT_EQ(sampleX(1.0), 1.0);
    mPlayback.activeClips = {false, false};
    EXPECT_EQ(sampleX(1.0), -1.0) << "the rest pose";
    mPlayback.activeClips = {}; // unset: all play
    EXPECT_EQ(sampleX(1.0), 101.0);
}

TEST_F(SampleAnimated, ChannelsOfDifferentPropertiesCombineInThePose) {
    mAnimated.channels = {{0, 0}, {1, 1}};
    const math::Transform pose = sampleAnimated(mAssets, mPlayback, mAnimated, mRest, 1.0);
    EXPECT_EQ(pose.translation, dvec3(1.0));
    EXPECT_EQ(pose.scale, dvec3(3.0));
    mAssets.clips[0].channels[0] = makeTurn(turnZ(0), turnZ(90));
    mAnimated.channels = {{0, 0}};
    const math::Transform turned = sampleAnimated(mAssets, mPlayback, mAnimated, mRest, 1.0);
    EXPECT_NEAR(turned.rotation.w, std::numbers::sqrt2 / 2.0, kTolerance);
    EXPECT_NEAR(turned.rotation.z, std::numbers::sqrt2 / 2.0, kTolerance);
    EXPECT_EQ(turned.translation, mRest.translation);
}

TEST_F(SampleAnimated, AClipHoldsAtTheEndsUnlessLoopingWhichWrapsByTheClip) {
    mAnimated.channels = {{0, 0}};
    EXPECT_EQ(sampleX(5.0), 4.0);
    EXPECT_EQ(sampleX(-1.0), 0.0);
    mPlayback.loop = true;
    EXPECT_EQ(sampleX(5.0), 1.0);
    EXPECT_EQ(sampleX(4.0), 0.0);
    EXPECT_EQ(sampleX(4001.5), 1.5);
    EXPECT_EQ(sampleX(-1.0), 3.0);
    mAssets.clips[0].duration = 10.0; // another channel runs longer
    EXPECT_EQ(sampleX(7.0), 4.0);
    EXPECT_EQ(sampleX(12.0), 2.0);
    mAssets.clips[0].duration = 0.0;
    mAssets.clips[0].channels[0].times = {0.0f};
    mAssets.clips[0].channels[0].values = {vec4(6.0f)};
    for (const double seconds : {-3.0, 0.0, 2.5, kInfinity, kNan})
        EXPECT_EQ(sampleX(seconds), 6.0);
}

constexpr double kLongest = 0.01;

class ClipJumpsTest : public testing::Test {
  protected:
    ClipJumpsTest() { mEntity = add(); }

    ecs::Entity add(ecs::Entity parent = {}) {
        const ecs::Entity entity = mWorld.registry.create();
        mWorld.registry.add(entity, LocalTransform{});
        if (parent != ecs::kNullEntity)
            mWorld.registry.add(entity, Parent{parent});
        return entity;
    }

    /// Drives an entity along x by a separate clip.
    void animate(
        ecs::Entity entity,
        Interpolation interpolation,
        std::vector<float> times,
        const std::vector<float>& places
    ) {
        AnimationClip clip;
        clip.duration = double{times.back()};
        AnimationChannel& channel = clip.channels.emplace_back();
        channel.interpolation = interpolation;
        channel.times = std::move(times);
        for (const float place : places)
            channel.values.emplace_back(place, 0.0f, 0.0f, 0.0f);
        const auto index = static_cast<uint32_t>(mWorld.assets.clips.size());
        mWorld.assets.clips.push_back(std::move(clip));
        mWorld.registry.add(entity, Animated{{{index, 0}}});
    }

    [[nodiscard]] std::vector<Jump> find(ecs::Entity entity, const TimeSpan& span) const {
        return ClipJumps(mWorld, span, kLongest).of(mWorld, entity);
    }

    [[nodiscard]] double placeAt(double seconds) const {
        return worldFromEntity(mWorld, mEntity, seconds)[3].x;
    }

    World mWorld;
    ecs::Entity mEntity;
};

TEST_F(ClipJumpsTest, AStepThatChangesAnythingWithinTheSpanIsAsShortAsRoundingAllows) {
    animate(mEntity, Interpolation::Step, {0.0f, 1.0f, 2.3f, 3.1f}, {1.0f, 1.0f, 4.0f, 5.0f});
    const std::vector<Jump> jumps = find(mEntity, {2.0, 2.5});
    ASSERT_EQ(jumps.size(), 1u);
    EXPECT_LT(jumps[0].after - jumps[0].before, 1e-13);
    EXPECT_EQ(placeAt(jumps[0].before), 1.0);
    EXPECT_EQ(placeAt(jumps[0].after), 4.0);
    EXPECT_TRUE(find(mEntity, {0.5, 1.5}).empty()) << "the value stays";
    EXPECT_TRUE(find(mEntity, {2.4, 2.9}).empty());
    EXPECT_EQ(find(mEntity, {-1.0, 9.0}).size(), 2u);
    const ecs::Entity whole = add();
    animate(whole, Interpolation::Step, {0.0f, 2.0f}, {1.0f, 4.0f});
    EXPECT_EQ(find(whole, {0.5, 2.0}).size(), 1u) << "at the span's end";
    EXPECT_EQ(find(whole, {2.0, 2.5}).size(), 1u) << "at its beginning";
}

TEST_F(ClipJumpsTest, OnlyNearlySimultaneousKeysOfStraightMotionAreAJump) {
    animate(mEntity, Interpolation::Linear, {0.0f, 1.0f, 1.005f, 1.05f, 2.0f}, {0, 0, 8, 9, 9});
    const std::vector<Jump> jumps = find(mEntity, {0.9, 1.1});
    ASSERT_EQ(jumps.size(), 1u) << "growth that takes its time goes a way";
    EXPECT_NEAR(jumps[0].before, 1.0, 1e-9);
    EXPECT_NEAR(jumps[0].after, 1.005, 1e-6);
    EXPECT_EQ(placeAt(jumps[0].before), 0.0);
    EXPECT_NEAR(placeAt(jumps[0].after), 8.0, 1e-6);
    EXPECT_EQ(find(mEntity, {1.002, 1.1}).size(), 1u) << "one that is on its way already";
}

TEST_F(ClipJumpsTest, ALoopMayJumpWhereItBeginsAnewAndAtItsKeysInEachRound) {
    mWorld.playback.loop = true;
    animate(mEntity, Interpolation::Linear, {0.0f, 0.25f}, {0.0f, 1.0f});
    std::vector<Jump> jumps = find(mEntity, {0.9, 1.6});
    ASSERT_EQ(jumps.size(), 3u);
    for (size_t i = 0; i < jumps.size(); ++i) {
        EXPECT_NEAR(jumps[i].before, 1.0 + 0.25 * double(i), 1e-12);
        EXPECT_NEAR(placeAt(jumps[i].before), 1.0, 1e-9);
        EXPECT_NEAR(placeAt(jumps[i].after), 0.0, 1e-9);
    }
    jumps = find(mEntity, {-0.6, -0.3});
    ASSERT_EQ(jumps.size(), 1u) << "before time 0, too";
    EXPECT_NEAR(placeAt(jumps[0].before), 1.0, 1e-9);
    EXPECT_NEAR(placeAt(jumps[0].after), 0.0, 1e-9);

    const ecs::Entity stepping = add();
    animate(stepping, Interpolation::Step, {0.0f, 0.1f, 0.25f}, {0.0f, 3.0f, 0.0f});
    EXPECT_EQ(find(stepping, {10.0 + 0.05, 10.0 + 0.45}).size(), 3u) << "two keys and a beginning";
    mWorld.playback.loop = false;
    EXPECT_TRUE(find(mEntity, {0.2, 1.6}).empty()) << "a clip that ends goes on as it ended";
}

TEST_F(ClipJumpsTest, ClipsWithTooManyLoopsAreIgnored) {
    mWorld.playback.loop = true;
    animate(mEntity, Interpolation::Linear, {0.0f, 1.0e-6f}, {0.0f, 1.0f});
    const auto count = [&](const TimeSpan& span) {
        return ClipJumps(mWorld, span, 1.0e-9).of(mWorld, mEntity).size();
    };
    EXPECT_EQ(count({0.0, 1.0}), 0u);
    EXPECT_EQ(count({0.25e-6, 3.5e-6}), 3u);
}

TEST_F(ClipJumpsTest, ChildrenAndSkinsJumpWithWhatTheyHangOn) {
    animate(mEntity, Interpolation::Step, {0.0f, 1.0f}, {0.0f, 1.0f});
    const ecs::Entity child = add(add(mEntity));
    EXPECT_EQ(find(child, {0.5, 1.5}).size(), 1u);
    const ecs::Entity other = add();
    EXPECT_TRUE(find(other, {0.5, 1.5}).empty());
    const ecs::Entity skinned = add();
    mWorld.registry.add(skinned, Skinned{0, {other, child, child}});
    EXPECT_EQ(find(skinned, {0.5, 1.5}).size(), 1u) << "once, though two joints have it";
}

TEST_F(ClipJumpsTest, WeightsOfMorphTargetsJumpForTheirEntityAloneAndWhileTheirClipPlays) {
    AnimationClip clip;
    clip.duration = 2.0;
    WeightChannel& channel = clip.weightChannels.emplace_back();
    channel.interpolation = Interpolation::Step;
    channel.targetCount = 2;
    channel.times = {0.0f, 1.0f, 2.0f};
    channel.values = {0.0f, 0.0f, 0.0f, 1.0f, 0.0f, 1.0f};
    mWorld.assets.clips.push_back(std::move(clip));
    mWorld.registry.add(mEntity, MorphWeights{{0.0f, 0.0f}, {{0, 0}}});
    EXPECT_EQ(find(mEntity, {0.5, 2.5}).size(), 1u);
    EXPECT_TRUE(find(add(mEntity), {0.5, 2.5}).empty());
    mWorld.playback.activeClips = {false};
    EXPECT_TRUE(find(mEntity, {0.5, 2.5}).empty());
    animate(mEntity, Interpolation::Step, {0.0f, 1.0f}, {0.0f, 1.0f});
    mWorld.playback.activeClips = {false, false};
    EXPECT_TRUE(ClipJumps(mWorld, {0.5, 1.5}, kLongest).empty());
    mWorld.playback.activeClips = {false, true};
    EXPECT_FALSE(ClipJumps(mWorld, {0.5, 1.5}, kLongest).empty());
}

} // namespace
} // namespace shutter::scene
