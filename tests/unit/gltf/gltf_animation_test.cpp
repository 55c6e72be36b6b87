// SPDX-License-Identifier: MIT
#include "tests/unit/gltf/gltf_fixture.h"

#include <gtest/gtest.h>

#include <cmath>

namespace shutter::gltf {
namespace {

using math::vec4;

const std::string kNodes = R"("scenes":[{"nodes":[0]}],"nodes":[{"name":"a"},{"name":"outside"}])";

std::string clip(
    const char* path,
    const char* interpolation = "LINEAR",
    const char* node = R"("node":0,)",
    int sampler = 0
) {
    return fmt::format(
        R"({{"name":"move","channels":[{{"sampler":{},"target":{{{}"path":"{}"}}}}],
        "samplers":[{{"input":0,"output":1,"interpolation":"{}"}}]}})",
        sampler,
        node,
        path,
        interpolation
    );
}

core::Result<LoadedScene>
loadClips(const GltfFile& file, const std::string& clips, const std::string& nodes = kNodes) {
    return file.load(nodes + R"(,"animations":[)" + clips + "]");
}

/// Accessor 0: times; accessor 1: values.
template <class T>
GltfFile makeKeys(
    const std::vector<float>& times,
    const std::vector<T>& values,
    const char* type,
    int componentType = kFloat
) {
    GltfFile file;
    file.add(times, kFloat, "SCALAR");
    file.add(values, componentType, type, componentType != kFloat);
    return file;
}

const std::vector<float> kTwoTimes = {0.5f, 2.0f};
const std::vector<float> kTwoVectors = {1, 2, 3, 4, 5, 6};

TEST(GltfAnimation, ALinearTranslationDrivesItsNode) {
    const GltfFile file = makeKeys(kTwoTimes, kTwoVectors, "VEC3");
    const LoadedScene scene = expectLoads(loadClips(file, clip("translation")));
    ASSERT_EQ(scene.world.assets.clips.size(), 1u);
    const scene::AnimationClip& moved = scene.world.assets.clips[0];
    EXPECT_EQ(moved.name, "move");
    EXPECT_EQ(moved.duration, 2.0);
    ASSERT_EQ(moved.channels.size(), 1u);
    const scene::AnimationChannel& channel = moved.channels[0];
    EXPECT_EQ(channel.node, 0u);
    EXPECT_EQ(channel.path, scene::AnimationPath::Translation);
    EXPECT_EQ(channel.interpolation, scene::Interpolation::Linear);
    EXPECT_EQ(channel.times, kTwoTimes);
    EXPECT_EQ(channel.values, (std::vector<vec4>{vec4(1, 2, 3, 0), vec4(4, 5, 6, 0)}));
    ASSERT_EQ(scene.world.playback.activeClips, std::vector<bool>{true});
    size_t driven = 0;
    for (const auto& [entity, animated] : scene.world.registry.view<const scene::Animated>()) {
        ++driven;
        ASSERT_EQ(animated.channels.size(), 1u);
        EXPECT_EQ(animated.channels[0].clip, 0u);
        EXPECT_EQ(animated.channels[0].channel, 0u);
    }
    EXPECT_EQ(driven, 1u);
}

TEST(GltfAnimation, ChannelsOfSeveralClipsComeInClipOrder) {
    const GltfFile file = makeKeys(kTwoTimes, kTwoVectors, "VEC3");
    const LoadedScene scene =
        expectLoads(loadClips(file, clip("scale", "STEP") + "," + clip("translation")));
    EXPECT_EQ(scene.world.assets.clips[0].channels[0].interpolation, scene::Interpolation::Step);
    EXPECT_EQ(scene.world.assets.clips[0].channels[0].path, scene::AnimationPath::Scale);
    for (const auto& [entity, animated] : scene.world.registry.view<const scene::Animated>()) {
        ASSERT_EQ(animated.channels.size(), 2u);
        EXPECT_EQ(animated.channels[0].clip, 0u);
        EXPECT_EQ(animated.channels[1].clip, 1u);
    }
    EXPECT_EQ(scene.world.playback.activeClips.size(), 2u);
}

/// Values of the only channel of the only clip.
std::vector<vec4> readValues(const GltfFile& file, const std::string& clips) {
    return expectLoads(loadClips(file, clips)).world.assets.clips.at(0).channels.at(0).values;
}

TEST(GltfAnimation, RotationsAreNormalizedAlsoFromIntegersButNotTheTangentsOfASpline) {
    const auto read = [](const auto& values, int type, const char* interpolation = "LINEAR") {
        return readValues(makeKeys({0.0f}, values, "VEC4", type), clip("rotation", interpolation));
    };
    using Values = std::vector<vec4>;
    EXPECT_EQ(read(std::vector<float>{0, 0, 3, 0}, kFloat), Values{vec4(0, 0, 1, 0)});
    EXPECT_EQ(read(std::vector<int16_t>{0, 0, -32768, 0}, kShort), Values{vec4(0, 0, -1, 0)});
    EXPECT_EQ(read(std::vector<int8_t>{127, 0, 0, 0}, kByte), Values{vec4(1, 0, 0, 0)});
    const std::vector<float> spline = {0, 0, 0, 0, 0, 0, 0, 2, 5, 5, 5, 5};
    EXPECT_EQ(read(spline, kFloat, "CUBICSPLINE"), (Values{vec4(0), vec4(0, 0, 0, 1), vec4(5)}));
}

TEST(GltfAnimation, RotationsWithoutABufferViewTurnNothing) {
    GltfFile file;
    file.add(kTwoTimes, kFloat, "SCALAR");
    file.addAccessor(R"({"componentType":5126,"count":2,"type":"VEC4"})");
    const LoadedScene scene = expectLoads(loadClips(file, clip("rotation")));
    EXPECT_EQ(scene.world.assets.clips.at(0).channels.at(0).values.at(1), vec4(0, 0, 0, 1));
    EXPECT_TRUE(hasWarning(scene, "output has no bufferView"));
}

TEST(GltfAnimation, KeysWithoutMeaningAreRefused) {
    const float nan = std::nanf("");
    const GltfFile still = makeKeys({0.0f}, std::vector<float>{0, 0, 0, 0}, "VEC4");
    expectRefused(loadClips(still, clip("rotation")), "has no length");
    const GltfFile broken = makeKeys(kTwoTimes, std::vector<float>{1, 2, nan, 4, 5, 6}, "VEC3");
    expectRefused(loadClips(broken, clip("translation")), "holds nan");
    for (const std::vector<float>& times : {std::vector<float>{nan, 1}, std::vector<float>{2, 1}}) {
        const GltfFile file = makeKeys(times, kTwoVectors, "VEC3");
        expectRefused(loadClips(file, clip("translation")), "animations[0].samplers[0].input");
    }
}

TEST(GltfAnimation, TheLastOfKeysAtOneTimeIsUsed) {
    const std::vector<float> times = {0, 1, 1, 2};
    const std::vector<float> values = {0, 0, 0, 1, 1, 1, 2, 2, 2, 3, 3, 3};
    const LoadedScene scene =
        expectLoads(loadClips(makeKeys(times, values, "VEC3"), clip("translation")));
    const scene::AnimationChannel& channel = scene.world.assets.clips[0].channels[0];
    EXPECT_EQ(channel.times, (std::vector<float>{0, 1, 2}));
    EXPECT_EQ(channel.values[1], vec4(2, 2, 2, 0));
    EXPECT_EQ(channel.values.size(), 3u);
    EXPECT_TRUE(hasWarning(scene, "equal times"));
}

TEST(GltfAnimation, ChannelsThatDriveNothingWeKnowAreIgnored) {
    const GltfFile file = makeKeys(kTwoTimes, kTwoVectors, "VEC3");
    const LoadedScene noNode = expectLoads(loadClips(file, clip("translation", "LINEAR", "")));
    EXPECT_TRUE(noNode.world.assets.clips[0].channels.empty());
    const LoadedScene weights = expectLoads(loadClips(file, clip("weights")));
    EXPECT_TRUE(weights.world.assets.clips[0].weightChannels.empty());
    EXPECT_TRUE(hasWarning(weights, "which has no morph targets"));
    const LoadedScene colour = expectLoads(loadClips(file, clip("colour")));
    EXPECT_TRUE(hasWarning(colour, "'colour'"));
}

TEST(GltfAnimation, NodesOutsideTheSceneAndOnesThatShearAreNotDriven) {
    const GltfFile file = makeKeys(kTwoTimes, kTwoVectors, "VEC3");
    const LoadedScene outside =
        expectLoads(loadClips(file, clip("translation", "LINEAR", R"("node":1,)")));
    EXPECT_EQ(outside.world.assets.clips[0].channels.size(), 1u);
    const auto animated = outside.world.registry.view<const scene::Animated>();
    EXPECT_TRUE(animated.begin() == animated.end()) << "an entity is driven";
    const LoadedScene sheared = expectLoads(loadClips(
        file,
        clip("translation"),
        R"("scenes":[{"nodes":[0]}],"nodes":[{"matrix":[1,0,0,0,1,1,0,0,0,0,1,0,0,0,0,1]}])"
    ));
    EXPECT_TRUE(hasWarning(sheared, "matrix that shears"));
}

TEST(GltfAnimation, ReferencesTypesAndCountsAreChecked) {
    const GltfFile file = makeKeys(kTwoTimes, kTwoVectors, "VEC3");
    expectEachRefused(
        [&](const std::string& clips) { return loadClips(file, clips); },
        {{clip("translation", "LINEAR", R"("node":0,)", 1),
          "channels[0].sampler is 1, but there is 1 sampler"},
         {clip("translation", "LINEAR", R"("node":7,)"), "target.node is 7"},
         {clip("translation", "BEZIER"), "'BEZIER'"},
         {clip("rotation"), "output: accessors[1].type"},
         {clip("translation", "CUBICSPLINE"), "2 values for 2 keys, not 6"}}
    );
    const GltfFile raw =
        makeKeys(std::vector<float>{0}, std::vector<uint32_t>{0, 0, 0}, "VEC3", kUnsignedInt);
    expectRefused(loadClips(raw, clip("translation")), "componentType 5125");
    const GltfFile spline = makeKeys(kTwoTimes, std::vector<float>(18, 0.5f), "VEC3");
    EXPECT_EQ(readValues(spline, clip("translation", "CUBICSPLINE")).size(), 6u);
}

} // namespace
} // namespace shutter::gltf
