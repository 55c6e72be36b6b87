// SPDX-License-Identifier: MIT
// Clips, instants, methods and the passes that count as theirs.
#include "engine/render/effect.h"
#include "game/shot/clips.h"
#include "game/shot/methods.h"
#include "game/shot/picture_drawer.h"
#include "game/shot/shot.h"
#include "tests/support/outcomes.h"

#include <gtest/gtest.h>

#include <initializer_list>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace shutter::game {
namespace {

using scene::AnimationPath;

class Clips : public testing::Test {
  protected:
    Clips() { mOptions.scene = "scene.gltf"; }

    ecs::Entity addNode() { return mWorld.registry.create(); }

    uint32_t addClip(const std::string& name) {
        mWorld.assets.clips.push_back({name, 1.0, {}, {}});
        return uint32_t(mWorld.assets.clips.size() - 1);
    }

    /// The clip moves the node.
    void move(uint32_t clip, ecs::Entity node, AnimationPath path = AnimationPath::Translation) {
        auto& channels = mWorld.assets.clips[clip].channels;
        scene::AnimationChannel channel;
        channel.path = path;
        channels.push_back(channel);
        if (!mWorld.registry.has<scene::Animated>(node))
            mWorld.registry.add(node, scene::Animated{});
        mWorld.registry.get<scene::Animated>(node).channels.push_back(
            {clip, uint32_t(channels.size() - 1)}
        );
    }

    void morph(uint32_t clip, ecs::Entity node) {
        auto& channels = mWorld.assets.clips[clip].weightChannels;
        channels.emplace_back();
        if (!mWorld.registry.has<scene::MorphWeights>(node))
            mWorld.registry.add(node, scene::MorphWeights{});
        mWorld.registry.get<scene::MorphWeights>(node).channels.push_back(
            {clip, uint32_t(channels.size() - 1)}
        );
    }

    /// What selectClips() prints.
    std::string
    select(std::vector<std::string> wanted, std::optional<uint32_t> flying = std::nullopt) {
        mOptions.clips = std::move(wanted);
        testing::internal::CaptureStderr();
        const core::Status done = selectClips(mWorld, mOptions, flying);
        std::string printed = testing::internal::GetCapturedStderr();
        return done ? printed : done.error().message;
    }

    void expectActive(std::initializer_list<bool> expected) const {
        EXPECT_EQ(mWorld.playback.activeClips, std::vector<bool>(expected));
    }

    static void expectContains(const std::string& text, const std::string& part) {
        EXPECT_NE(text.find(part), std::string::npos) << text;
    }

    scene::World mWorld;
    ShotOptions mOptions;
};

TEST_F(Clips, ANameWinsOverAnIndexAndMeansAllThatHaveIt) {
    for (const char* name : {"walk", "", "walk", "1"})
        addClip(name);
    EXPECT_EQ(findClips(mWorld, "walk"), (std::vector<uint32_t>{0, 2}));
    EXPECT_EQ(findClips(mWorld, "1"), std::vector<uint32_t>{3});
    EXPECT_EQ(findClips(mWorld, "0"), std::vector<uint32_t>{0});
    EXPECT_EQ(findClips(mWorld, "2"), std::vector<uint32_t>{2});
    for (const char* none : {"", "4", "-1", "+1", "0x1", "1 ", "99999999999", "Walk"})
        EXPECT_TRUE(findClips(mWorld, none).empty()) << none;
}

TEST_F(Clips, ClipsWithoutANameAreChosenByIndex) {
    const ecs::Entity node = addNode();
    for (const char* name : {"", "turn", ""})
        move(addClip(name), node);
    EXPECT_EQ(select({"2"}), "");
    expectActive({false, false, true});
    EXPECT_EQ(select({"0"}), "");
    expectActive({true, false, false});
    EXPECT_EQ(select({"turn"}), "");
    expectActive({false, true, false});
    EXPECT_EQ(select({"none"}), "");
    expectActive({false, false, false});
}

TEST_F(Clips, UnknownClipsAreRefusedWithAList) {
    expectContains(select({"0"}), "scene.gltf: --clip '0' is none of its clips (it has none)");
    addClip("walk");
    addClip("");
    for (const char* wrong : {"2", "run", ""})
        expectContains(
            select({wrong}),
            std::string("--clip '") + wrong + "' is none of its clips (0 'walk', 1 without a name)"
        );
}

TEST_F(Clips, ClipsOfOneNodePlayOneAtATime) {
    const ecs::Entity hip = addNode();
    const ecs::Entity hand = addNode();
    const uint32_t idle = addClip("idle");
    move(idle, hip);
    move(idle, hip, AnimationPath::Scale);
    const uint32_t walk = addClip("walk");
    move(walk, hand, AnimationPath::Rotation);
    move(walk, hip);
    const uint32_t wave = addClip("wave");
    move(wave, hand, AnimationPath::Rotation);
    const uint32_t door = addClip("door");
    move(door, addNode());
    const std::string printed = select({});
    expectActive({true, false, true, true}); // of walk and wave the later one, so idle may play
    expectContains(printed, "warning: scene.gltf: 1 of its 4 clips does not play");
    expectContains(printed, ": 1 'walk'; --clip chooses");
    EXPECT_FALSE(describeRestingClips(mWorld).empty());
    select({}, walk);
    expectActive({false, true, false, true});
    const uint32_t run = addClip("run");
    move(run, hip);
    expectContains(select({}), "2 of its 5 clips do not play");
    expectActive({false, false, true, true, true});
}

TEST_F(Clips, ClipsThatMoveDifferentThingsPlayTogether) {
    const ecs::Entity node = addNode();
    move(addClip("bob"), node);
    move(addClip("spin"), node, AnimationPath::Rotation);
    morph(addClip("smile"), node);
    addClip("moves nothing");
    EXPECT_EQ(select({}), "");
    expectActive({true, true, true, true});
    EXPECT_EQ(describeRestingClips(mWorld), "");
    morph(addClip("frown"), node);
    expectContains(select({}), "2 'smile'");
    expectActive({true, true, false, true, true});
}

TEST_F(Clips, NamedClipsPlayEvenIfTheyDriveTheSameProperties) {
    const ecs::Entity node = addNode();
    move(addClip("take"), node);
    move(addClip("take"), node);
    move(addClip("turn"), node, AnimationPath::Rotation);
    EXPECT_EQ(select({"0", "turn"}), "");
    const std::string printed = select({"take"});
    expectActive({true, true, false});
    expectContains(printed, "warning: scene.gltf: --clip");
    expectContains(printed, "--clip: 0 'take' moves nodes that a later chosen clip moves");
}

TEST_F(Clips, AWarningAboutThousandsNamesAFew) {
    const ecs::Entity node = addNode();
    for (int i = 0; i < 2000; ++i)
        move(addClip(""), node);
    const std::string printed = select({});
    expectContains(printed, "1999 of its 2000 clips do not play,");
    expectContains(printed, "7 without a name, 1991 more;");
    EXPECT_LT(printed.size(), 400u);
}

TEST_F(Clips, AFlightTakesTheClipThatMovesACameraAndRestsTheOthersOfIt) {
    const ecs::Entity box = addNode();
    const ecs::Entity camera = addNode();
    mWorld.registry.add(camera, scene::Camera{});
    mWorld.cameras.push_back(camera);
    move(addClip(""), camera);
    move(addClip("take"), box);
    move(addClip("take"), camera);
    for (const auto& [wanted, clip] : {std::pair("take", 2u), {"0", 0u}, {"2", 2u}}) {
        mOptions.flythroughClip = wanted;
        select({}, clip);
        EXPECT_EQ(test::valueOf(chooseClipCamera(mWorld, mOptions)), camera);
        expectActive({clip == 0, true, clip == 2});
        mOptions.frameTimes.clear();
        EXPECT_TRUE(planClipFrames(mWorld, mOptions));
    }
    mOptions.flythroughClip = "1";
    const char* still = "--flythrough clip:1 moves no camera";
    test::expectRefused(chooseClipCamera(mWorld, mOptions), still);
    mOptions.flythroughClip = "7";
    const char* listed = "(0 without a name, 1 'take', 2 'take')";
    test::expectRefused(chooseClipCamera(mWorld, mOptions), listed);
}

TEST(Instants, AStaticFrameTakesOneInstantAndAMovingLightOrAFlashSome) {
    const InstantChoice choice = chooseInstants({}, 1.0, 1024);
    EXPECT_EQ(choice.count, 1u);
    EXPECT_EQ(choice.reason, "nothing moves");
    const InstantChoice lit = chooseInstants({0.0, true}, 1.0, 1024);
    EXPECT_EQ(lit.count, kMinInstantsOfLight);
    EXPECT_EQ(lit.reason, "only light moves");
    EXPECT_EQ(chooseInstants({0.0, true}, 1.0, 4).count, 4u);
    const InstantChoice flash = chooseInstants({0.0, false, true}, 1.0, 1024);
    EXPECT_EQ(flash.count, kMinInstantsOfLight);
    EXPECT_EQ(flash.reason, "nothing moves, but something comes, goes or changes its colour");
}

TEST(Instants, InstantsAreNoFartherApartThanTheStepUpToTheMaximum) {
    EXPECT_EQ(chooseInstants({10.0, false}, 1.0, 1024).count, 10u);
    EXPECT_EQ(chooseInstants({10.1, false}, 1.0, 1024).count, 11u);
    EXPECT_EQ(chooseInstants({10.0, false}, 4.0, 1024).count, 3u);
    EXPECT_EQ(chooseInstants({0.2, false}, 1.0, 1024).count, 1u);
    const InstantChoice choice = chooseInstants({1000.0, false}, 1.0, 100);
    EXPECT_EQ(choice.count, 100u);
    EXPECT_DOUBLE_EQ(choice.stepPx, 10.0);
    EXPECT_EQ(chooseInstants({1.0e300, false}, 1.0e-3, 100).count, 100u);
    EXPECT_EQ(chooseInstants({std::numeric_limits<double>::infinity(), false}, 1.0, 7).count, 7u);
}

TEST(Methods, EachIsFoundByItsOwnNameAndAnUnknownOneAnsweredWithThem) {
    for (const MethodInfo& method : listMethods()) {
        EXPECT_EQ(test::valueOf(findMethod(method.name)), &method);
        EXPECT_FALSE(std::string(method.description).empty());
        EXPECT_EQ(method.sampleUnit.has_value(), method.defaultSamples != 0) << method.name;
    }
    const auto unknown = findMethod("nosuch");
    ASSERT_FALSE(unknown.ok());
    for (const char* part :
         {"--method", "nosuch", "sharp", "gather", "hybrid", "accumulate", "truth"})
        EXPECT_NE(unknown.error().message.find(part), std::string::npos) << part;
}

using render::PassOwner;

PassGroup groupIn(const char* method, PassOwner owner) {
    return groupOf(*findMethod(method).value(), owner);
}

/// An effect with the minimal interface.
class PlainEffect : public render::Effect {
    [[nodiscard]] std::string name() const override { return "plain"; }

    [[nodiscard]] render::Needs decide(const render::DecideContext&) const override { return {}; }

    void declare(render::PictureContext&) override {}
};

TEST(PassGroups, AMethodPaysForItsBlurItsRaysAndAllThatItDrawsItself) {
    for (const char* method : {"hybrid", "denoised"}) {
        EXPECT_EQ(groupIn(method, PassOwner::Scene), PassGroup::Scene) << method;
        EXPECT_EQ(groupIn(method, PassOwner::Rays), PassGroup::Blur) << method;
        EXPECT_EQ(groupIn(method, PassOwner::Blur), PassGroup::Blur) << method;
    }
    for (const PassOwner owner : {PassOwner::Scene, PassOwner::Rays, PassOwner::Other})
        EXPECT_NE(groupIn("sharp", owner), PassGroup::Blur);
    EXPECT_EQ(groupIn("gather", PassOwner::Rays), PassGroup::Other);
    for (const char* method : {"accumulate", "truth"})
        EXPECT_EQ(groupIn(method, PassOwner::Scene), PassGroup::Blur) << method;
}

TEST(PassGroups, AFilterOfTheLensIsWhatASharpMethodAdds) {
    MethodInfo filtered = *findMethod("sharp").value();
    filtered.lensFilter = &depth_of_field::getFilter("near_far");
    EXPECT_EQ(groupOf(filtered, PassOwner::Blur), PassGroup::Blur);
    EXPECT_EQ(groupOf(filtered, PassOwner::Scene), PassGroup::Scene);
    EXPECT_EQ(groupIn("sharp", PassOwner::Blur), PassGroup::Scene);
}

TEST(PassGroups, NoMethodPaysForAnEffectThatClaimsNothingOrForTheDisplay) {
    for (const MethodInfo& method : listMethods()) {
        EXPECT_EQ(groupOf(method, PlainEffect().owner()), PassGroup::Other) << method.name;
        EXPECT_EQ(groupOf(method, PassOwner::Display), PassGroup::Display) << method.name;
    }
}

TEST(PassGroups, SumsCountEachPassOnce) {
    render::FrameStatistics frame;
    frame.passes = {
        {{"deform meshes", 1.0}, PassOwner::Scene},
        {{"build TLAS", 2.0}, PassOwner::Rays},
        {{"G-buffer", 4.0}, PassOwner::Scene},
        {{"gather", 8.0}, PassOwner::Blur},
        {{"bloom", 32.0}, PassOwner::Other},
        {{"tone map", 16.0}, PassOwner::Display}};
    EXPECT_EQ(sumBlurMilliseconds(*findMethod("hybrid").value(), frame), 10.0);
    EXPECT_EQ(sumBlurMilliseconds(*findMethod("accumulate").value(), frame), 13.0);
    EXPECT_EQ(sumFrameMilliseconds(frame), 47.0);
}

} // namespace
} // namespace shutter::game
