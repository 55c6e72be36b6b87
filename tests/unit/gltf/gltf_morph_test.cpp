// SPDX-License-Identifier: MIT
// Morph targets: deltas, weights at rest, weights in clips.
#include "tests/unit/gltf/gltf_fixture.h"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

namespace shutter::gltf {

namespace {

using math::vec3;

const std::vector<float> kUp = {0, 0, 1, 0, 0, 1, 0, 0, 1};
const std::vector<float> kDeltas = {0, 0, 0, 0, 2, 0, 0, 0, 3};

/// Accessor 0: a triangle; 1: its normals; 2: deltas.
GltfFile makeFile() {
    GltfFile file;
    file.add(kTriangle, kFloat, "VEC3");
    file.add(kUp, kFloat, "VEC3");
    file.add(kDeltas, kFloat, "VEC3");
    return file;
}

std::string
mesh(const std::string& targets, const std::string& attributes = R"("POSITION":0,"NORMAL":1)") {
    return R"("meshes":[{"primitives":[{"attributes":{)" + attributes + R"(},"targets":[)" +
           targets + "]}]}]";
}

std::string weightedMesh(const std::string& weights, const std::string& nodeWeights = "") {
    return R"("meshes":[{"primitives":[{"attributes":{"POSITION":0,"NORMAL":1},"targets":[)"
           R"({"POSITION":2},{"NORMAL":2}]}])" +
           weights + R"(}],"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0)" + nodeWeights + "}]";
}

const scene::MorphWeights& weightsOf(const LoadedScene& scene) {
    for (const auto& [entity, morph] : scene.world.registry.view<const scene::MorphWeights>())
        return morph;
    throw std::runtime_error("nothing is morphed");
}

TEST(GltfMorph, TargetsHoldWhatTheyMove) {
    const LoadedScene scene =
        expectLoads(makeFile().load(mesh(R"({"POSITION":2},{"POSITION":2,"NORMAL":2},{})")));
    EXPECT_TRUE(scene.warnings.empty());
    const scene::Primitive& primitive = primitiveOf(scene);
    ASSERT_EQ(primitive.morphTargets.size(), 3u);
    const std::vector<vec3> deltas = {vec3(0), vec3(0, 2, 0), vec3(0, 0, 3)};
    EXPECT_EQ(primitive.morphTargets[0].positions, deltas);
    EXPECT_TRUE(primitive.morphTargets[0].normals.empty());
    EXPECT_EQ(primitive.morphTargets[1].normals, deltas);
    EXPECT_TRUE(primitive.morphTargets[2].positions.empty());
    EXPECT_EQ(scene.world.assets.meshes[0].morphWeights, (std::vector<float>{0, 0, 0}));
    EXPECT_EQ(scene.world.assets.meshes[0].bounds.max, math::dvec3(1, 1, 0)) << "undeformed";
}

TEST(GltfMorph, ASparseTargetMovesOnlyTheVerticesItNames) {
    GltfFile file = makeFile();
    const int indices = file.addView(std::vector<uint16_t>{2});
    const int values = file.addView(std::vector<float>{0, 0, 9});
    file.addAccessor(fmt::format(
        R"({{"componentType":5126,"count":3,"type":"VEC3","sparse":{{"count":1,
        "indices":{{"bufferView":{},"componentType":5123}},"values":{{"bufferView":{}}}}}}})",
        indices,
        values
    ));
    const LoadedScene scene = expectLoads(file.load(mesh(R"({"POSITION":3})")));
    const std::vector<vec3> deltas = {vec3(0), vec3(0), vec3(0, 0, 9)};
    EXPECT_EQ(primitiveOf(scene).morphTargets.at(0).positions, deltas);
}

TEST(GltfMorph, QuantizedTargetsNeedTheExtension) {
    GltfFile file = makeFile();
    file.add(std::vector<int8_t>{0, 0, 0, 127, 0, 0, 0, -128, 0}, kByte, "VEC3", true);
    const std::string members = mesh(R"({"POSITION":3})");
    expectRefused(file.load(members), "targets[0].POSITION: accessors[3].componentType 5120");
    const LoadedScene scene =
        expectLoads(file.load(R"("extensionsUsed":["KHR_mesh_quantization"],)" + members));
    const std::vector<vec3> deltas = {vec3(0), vec3(1, 0, 0), vec3(0, -1, 0)};
    EXPECT_EQ(primitiveOf(scene).morphTargets.at(0).positions, deltas);
}

TEST(GltfMorph, TargetsFollowVerticesThatTheLoaderDoublesOrRemoves) {
    GltfFile file;
    const float nan = std::numeric_limits<float>::quiet_NaN();
    file.add(std::vector<float>{nan, 0, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0}, kFloat, "VEC3");
    file.add(std::vector<float>{9, 9, 9, 1, 0, 0, 2, 0, 0, 3, 0, 0, 4, 0, 0}, kFloat, "VEC3");
    file.add(std::vector<uint16_t>{0, 1, 2, 1, 2, 3, 3, 2, 4}, kUnsignedShort, "SCALAR");
    const LoadedScene scene = expectLoads(file.load(
        R"("meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":2,
        "targets":[{"POSITION":1,"NORMAL":1}]}]}])"
    ));
    const scene::MorphTarget& target = primitiveOf(scene).morphTargets.at(0);
    ASSERT_EQ(target.positions.size(), 6u);
    const std::vector<float> expected = {1, 2, 3, 3, 2, 4};
    for (size_t i = 0; i < 6; ++i)
        EXPECT_EQ(target.positions[i].x, expected[i]);
    EXPECT_TRUE(target.normals.empty()) << "there are no normals they could be added to";
}

TEST(GltfMorph, DeltasThatAreNotFiniteAreZero) {
    GltfFile file = makeFile();
    const float infinity = std::numeric_limits<float>::infinity();
    file.add(std::vector<float>{0, infinity, 0, 1, 1, 1, 0, 0, 0}, kFloat, "VEC3");
    const LoadedScene scene = expectLoads(file.load(mesh(R"({"POSITION":3})")));
    EXPECT_EQ(primitiveOf(scene).morphTargets.at(0).positions[0], vec3(0));
    EXPECT_EQ(primitiveOf(scene).morphTargets.at(0).positions[1], vec3(1));
    EXPECT_TRUE(hasWarning(scene, "targets[0].POSITION holds values that are not finite"));
}

TEST(GltfMorph, TangentsMoveOnlyWhereTheMeshGivesSome) {
    GltfFile file = makeFile();
    file.add(std::vector<float>{1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1}, kFloat, "VEC4");
    file.add(std::vector<float>{0, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1}, kFloat, "VEC4");
    const std::string target = R"({"TANGENT":2})";
    const std::string attributes = R"("POSITION":0,"NORMAL":1,"TANGENT":)";
    const LoadedScene given = expectLoads(file.load(mesh(target, attributes + "3")));
    EXPECT_EQ(primitiveOf(given).morphTargets.at(0).tangents.size(), 3u);
    const LoadedScene broken = expectLoads(file.load(mesh(target, attributes + "4")));
    EXPECT_TRUE(primitiveOf(broken).morphTargets.at(0).tangents.empty());
    const LoadedScene none = expectLoads(file.load(mesh(target)));
    EXPECT_TRUE(primitiveOf(none).morphTargets.at(0).tangents.empty());
}

TEST(GltfMorph, OtherAttributesAreIgnoredWithAWarning) {
    const LoadedScene scene = expectLoads(makeFile().load(mesh(R"({"POSITION":2,"COLOR_0":2})")));
    EXPECT_TRUE(hasWarning(scene, "morph targets of COLOR_0 are ignored"));
}

TEST(GltfMorph, TargetsThatDoNotFitAreRefused) {
    GltfFile file = makeFile();
    file.add(std::vector<float>{0, 0, 1}, kFloat, "VEC3");
    expectRefused(
        file.load(mesh(R"({"POSITION":3})")), "targets[0].POSITION has 1 element, POSITION has 3"
    );
    expectRefused(file.load(mesh(R"({"TEXCOORD_0":3})")), "targets[0].TEXCOORD_0 has 1 element,");
    expectRefused(file.load(mesh(R"({"POSITION":9})")), "targets[0].POSITION is 9");
    expectRefused(
        file.load(R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}},
            {"attributes":{"POSITION":0},"targets":[{"POSITION":2}]}]}])"),
        "meshes[0].primitives[1].targets has 1 morph target, primitives[0] has 0"
    );
}

TEST(GltfMorph, TheNodesWeightsGoBeforeTheMeshs) {
    const GltfFile file = makeFile();
    const LoadedScene none = expectLoads(file.load(weightedMesh("")));
    EXPECT_EQ(weightsOf(none).weights, (std::vector<float>{0, 0}));
    const LoadedScene ofMesh = expectLoads(file.load(weightedMesh(R"(,"weights":[0.5,-1])")));
    EXPECT_EQ(weightsOf(ofMesh).weights, (std::vector<float>{0.5f, -1}));
    EXPECT_EQ(ofMesh.world.assets.meshes[0].morphWeights, (std::vector<float>{0.5f, -1}));
    const LoadedScene ofNode =
        expectLoads(file.load(weightedMesh(R"(,"weights":[0.5,-1])", R"(,"weights":[2,3])")));
    EXPECT_EQ(weightsOf(ofNode).weights, (std::vector<float>{2, 3}));
    EXPECT_EQ(ofNode.world.assets.meshes[0].morphWeights, (std::vector<float>{0.5f, -1}));
}

TEST(GltfMorph, WeightsThatDoNotFitAreRefused) {
    const GltfFile file = makeFile();
    expectRefused(
        file.load(weightedMesh(R"(,"weights":[1])")),
        "meshes[0].weights has 1 number, but the mesh has 2 morph targets"
    );
    expectRefused(
        file.load(weightedMesh("", R"(,"weights":[1,2,3])")), "nodes[0].weights has 3 numbers"
    );
    expectRefused(file.load(weightedMesh("", R"(,"weights":[1,1e31])")), "nodes[0].weights holds");
}

/// Two morph targets; accessor 3: times 0 and 1; 4: `values`.
template <class T>
core::Result<LoadedScene> loadClip(
    const std::vector<T>& values, int type, const char* interpolation, const char* channel = ""
) {
    GltfFile file = makeFile();
    file.add(std::vector<float>{0, 1}, kFloat, "SCALAR");
    file.add(values, type, "SCALAR", type != kFloat);
    return file.load(
        weightedMesh("") + R"(,"animations":[{"channels":[)" + channel +
        fmt::format(
            R"({{"sampler":0,"target":{{"node":0,"path":"weights"}}}}],
            "samplers":[{{"input":3,"output":4,"interpolation":"{}"}},{{"input":3,"output":0}}]}}])",
            interpolation
        )
    );
}

TEST(GltfMorph, AClipDrivesTheWeightsOfItsNode) {
    const LoadedScene scene =
        expectLoads(loadClip(std::vector<float>{0, 1, 2, 3}, kFloat, "LINEAR"));
    EXPECT_TRUE(scene.warnings.empty());
    const scene::AnimationClip& clip = scene.world.assets.clips.at(0);
    EXPECT_EQ(clip.duration, 1.0);
    EXPECT_TRUE(clip.channels.empty());
    ASSERT_EQ(clip.weightChannels.size(), 1u);
    const scene::WeightChannel& channel = clip.weightChannels[0];
    EXPECT_EQ(channel.node, 0u);
    EXPECT_EQ(channel.targetCount, 2u);
    EXPECT_EQ(channel.times, (std::vector<float>{0, 1}));
    EXPECT_EQ(channel.values, (std::vector<float>{0, 1, 2, 3}));
    ASSERT_EQ(weightsOf(scene).channels.size(), 1u);
    EXPECT_EQ(weightsOf(scene).channels[0].clip, 0u);
    EXPECT_EQ(weightsOf(scene).channels[0].channel, 0u);
}

TEST(GltfMorph, WeightsOfClipsComeAsStepsSplinesAndIntegersToo) {
    const LoadedScene step = expectLoads(loadClip(std::vector<float>(4), kFloat, "STEP"));
    const auto& steps = step.world.assets.clips.at(0).weightChannels.at(0);
    EXPECT_EQ(steps.interpolation, scene::Interpolation::Step);
    const LoadedScene cubic = expectLoads(loadClip(std::vector<float>(12), kFloat, "CUBICSPLINE"));
    EXPECT_EQ(cubic.world.assets.clips.at(0).weightChannels.at(0).values.size(), 12u);
    const std::vector<uint8_t> bytes = {0, 51, 255, 0};
    const LoadedScene integers = expectLoads(loadClip(bytes, kUnsignedByte, "LINEAR"));
    EXPECT_EQ(
        integers.world.assets.clips.at(0).weightChannels.at(0).values,
        (std::vector<float>{0, 0.2f, 1, 0})
    );
}

TEST(GltfMorph, WeightsOfClipsThatDoNotFitAreRefused) {
    expectRefused(
        loadClip(std::vector<float>{0, 1, 2}, kFloat, "LINEAR"),
        "animations[0].samplers[0] has 3 values for 2 keys, not 4"
    );
    expectRefused(
        loadClip(std::vector<float>(4), kFloat, "CUBICSPLINE"), "4 values for 2 keys, not 12"
    );
    const float nan = std::numeric_limits<float>::quiet_NaN();
    expectRefused(
        loadClip(std::vector<float>{0, nan, 0, 0}, kFloat, "LINEAR"), "samplers[0].output holds nan"
    );
}

} // namespace

} // namespace shutter::gltf
