// SPDX-License-Identifier: MIT
// When clips may jump, held against the definition: the pose on both sides of a jump is that of the
// keys, and nothing that goes a way is one.
#include "engine/scene/clip_jumps.h"
#include "engine/scene/motion.h"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

namespace shutter::scene {
namespace {

using math::vec4;

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

    /// Drives an entity along x by a clip of its own.
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

TEST_F(ClipJumpsTest, AStepIsAsShortAsRoundingAllowsAndLiesBetweenTheTwoPlaces) {
    animate(mEntity, Interpolation::Step, {0.0f, 0.7f, 1.3f}, {1.0f, 5.0f, 9.0f});
    const std::vector<Jump> jumps = find(mEntity, {0.5, 1.0});
    ASSERT_EQ(jumps.size(), 1u);
    EXPECT_LT(jumps[0].after - jumps[0].before, 1e-13);
    EXPECT_EQ(placeAt(jumps[0].before), 1.0);
    EXPECT_EQ(placeAt(jumps[0].after), 5.0);
}

TEST_F(ClipJumpsTest, KeysOutsideTheSpanAndKeysThatChangeNothingAreNone) {
    animate(mEntity, Interpolation::Step, {0.0f, 1.0f, 2.0f, 3.0f}, {1.0f, 1.0f, 4.0f, 5.0f});
    EXPECT_TRUE(find(mEntity, {0.5, 1.5}).empty()) << "the value stays";
    EXPECT_TRUE(find(mEntity, {2.1, 2.9}).empty());
    EXPECT_EQ(find(mEntity, {0.5, 2.0}).size(), 1u) << "at the span's end";
    EXPECT_EQ(find(mEntity, {2.0, 2.5}).size(), 1u) << "at its beginning";
    EXPECT_EQ(find(mEntity, {-1.0, 9.0}).size(), 2u);
}

TEST_F(ClipJumpsTest, OfStraightMotionOnlyKeysAtNearlyTheSameTimeAreOne) {
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

TEST_F(ClipJumpsTest, SoManyRoundsThatNoneIsSeenAreNotLookedAt) {
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

TEST_F(ClipJumpsTest, WeightsOfMorphTargetsJumpForTheirEntityAlone) {
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
}

TEST_F(ClipJumpsTest, AClipThatDoesNotPlayDoesNotJump) {
    animate(mEntity, Interpolation::Step, {0.0f, 1.0f}, {0.0f, 1.0f});
    mWorld.playback.activeClips = {false};
    EXPECT_TRUE(ClipJumps(mWorld, {0.5, 1.5}, kLongest).empty());
    mWorld.playback.activeClips = {true};
    EXPECT_FALSE(ClipJumps(mWorld, {0.5, 1.5}, kLongest).empty());
}

} // namespace
} // namespace shutter::scene
