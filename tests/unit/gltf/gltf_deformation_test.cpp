// SPDX-License-Identifier: MIT
// Skins and morph targets in vertices, nodes and clips.
#include "engine/scene/deformation.h"
#include "engine/scene/motion.h"
#include "tests/unit/gltf/gltf_fixture.h"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

namespace shutter::gltf {
namespace {

using math::dmat4;
using math::dvec3;
using math::vec3;

/// Nodes 0: drawn with skin 0; 1: a joint with the joint 2 below. All in the scene.
const std::string kSkinNodes =
    R"("scenes":[{"nodes":[0,1]}],"nodes":[{"mesh":0,"skin":0,"name":"body"},
    {"children":[2],"translation":[1,0,0]},{"translation":[0,2,0]}],)";
const std::string kTwoJoints = R"("skins":[{"name":"rig","joints":[1,2]}])";

std::string skinnedMesh(const std::string& attributes) {
    return R"("meshes":[{"primitives":[{"attributes":{"POSITION":0)" + attributes + "}}]}],";
}

const std::string kMesh = skinnedMesh(R"(,"JOINTS_0":1,"WEIGHTS_0":2)");

/// Accessor 0: a triangle; 1: joints; 2: weights, four of each a vertex.
template <class Joint, class Weight>
GltfFile makeSkinned(
    const std::vector<Joint>& joints,
    int jointType,
    const std::vector<Weight>& weights,
    int weightType
) {
    GltfFile file;
    file.add(kTriangle, kFloat, "VEC3");
    file.add(joints, jointType, "VEC4");
    file.add(weights, weightType, "VEC4", weightType != kFloat);
    return file;
}

const std::vector<uint8_t> kJoints = {0, 1, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0};
const std::vector<float> kWeights = {0.75f, 0.25f, 0, 0, 1, 0, 0, 0, 0.5f, 0.5f, 0, 0};

GltfFile makeSkinned() {
    return makeSkinned(kJoints, kUnsignedByte, kWeights, kFloat);
}

ecs::Entity findSkinned(const scene::World& world) {
    for (const auto& [entity, skinned] : world.registry.view<const scene::Skinned>())
        return entity;
    return ecs::kNullEntity;
}

TEST(GltfSkin, ASkinnedNodeKnowsItsJointsAndItsMeshItsInfluences) {
    const LoadedScene scene = makeSkinned().read(kMesh + kSkinNodes + kTwoJoints);
    EXPECT_TRUE(scene.warnings.empty()) << scene.warnings[0];
    const scene::World& world = scene.world;
    ASSERT_EQ(world.assets.skins.size(), 1u);
    EXPECT_EQ(world.assets.skins[0].name, "rig");
    EXPECT_EQ(world.assets.skins[0].jointFromBind, (std::vector<dmat4>{dmat4(1.0), dmat4(1.0)}));
    const ecs::Entity body = findSkinned(world);
    ASSERT_NE(body, ecs::kNullEntity);
    EXPECT_EQ(world.registry.get<scene::Name>(body).value, "body");
    const auto& skinned = world.registry.get<scene::Skinned>(body);
    EXPECT_EQ(skinned.skin, 0u);
    ASSERT_EQ(skinned.joints.size(), 2u);
    EXPECT_EQ(dvec3(scene::worldFromEntity(world, skinned.joints[1], 0.0)[3]), dvec3(1, 2, 0));
    // Flat normals give every triangle separate corners: influences follow.
    const scene::Primitive& primitive = primitiveOf(scene);
    EXPECT_EQ(primitive.influenceCount, 4u);
    EXPECT_EQ(primitive.joints, (std::vector<uint16_t>{0, 1, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0}));
    EXPECT_EQ(primitive.weights, kWeights);
}

TEST(GltfSkin, JointsAndWeightsComeInEveryTypeAndWeightsSumToOne) {
    const std::vector<uint16_t> joints(kJoints.begin(), kJoints.end());
    const std::vector<uint8_t> bytes = {100, 100, 54, 0, 255, 0, 0, 0, 1, 1, 1, 1};
    const std::vector<uint16_t> shorts = {30000, 1, 1, 1, 65535, 65535, 0, 0, 1, 2, 3, 4};
    const std::vector<float> floats = {1e-40f, 0, 0, 3e-40f, 3e38f, 3e38f, 0, 0, 1, 2, 3, 4};
    for (const GltfFile& file :
         {makeSkinned(joints, kUnsignedShort, bytes, kUnsignedByte),
          makeSkinned(kJoints, kUnsignedByte, shorts, kUnsignedShort),
          makeSkinned(kJoints, kUnsignedByte, floats, kFloat)}) {
        const LoadedScene scene = file.read(kMesh + kSkinNodes + kTwoJoints);
        EXPECT_TRUE(scene.warnings.empty());
        const std::vector<float>& weights = primitiveOf(scene).weights;
        ASSERT_EQ(weights.size(), 12u);
        for (size_t v = 0; v < 12; v += 4) {
            double sum = 0.0;
            for (size_t i = v; i < v + 4; ++i)
                sum += double{weights[i]};
            EXPECT_NEAR(sum, 1.0, 2e-7);
        }
    }
}

TEST(GltfSkin, TwoSetsMakeEightInfluencesOfAVertex) {
    GltfFile file = makeSkinned();
    file.add(std::vector<uint8_t>{1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1}, kUnsignedByte, "VEC4");
    file.add(std::vector<float>{1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 3}, kFloat, "VEC4");
    const LoadedScene scene = file.read(
        skinnedMesh(R"(,"JOINTS_0":1,"WEIGHTS_0":2,"JOINTS_1":3,"WEIGHTS_1":4)") + kSkinNodes +
        kTwoJoints
    );
    const scene::Primitive& primitive = primitiveOf(scene);
    EXPECT_EQ(primitive.influenceCount, 8u);
    ASSERT_EQ(primitive.weights.size(), 24u);
    EXPECT_FLOAT_EQ(primitive.weights[0], 0.375f);
    EXPECT_FLOAT_EQ(primitive.weights[1], 0.125f);
    EXPECT_FLOAT_EQ(primitive.weights[4], 0.5f);
    EXPECT_FLOAT_EQ(primitive.weights[23], 0.75f);
    EXPECT_EQ(primitive.joints[4], 1u);
    const LoadedScene more = file.read(
        skinnedMesh(
            R"(,"JOINTS_0":1,"WEIGHTS_0":2,"JOINTS_1":3,"WEIGHTS_1":4,"JOINTS_2":3,"WEIGHTS_2":4)"
        ) +
        kSkinNodes + kTwoJoints
    );
    EXPECT_EQ(primitiveOf(more).influenceCount, 8u);
    EXPECT_TRUE(hasWarning(more, "more than eight joints"));
}

TEST(GltfSkin, WeightsThatMeanNothingAreZeroAndAVertexWithoutAnyFollowsItsFirstJoint) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const float infinity = std::numeric_limits<float>::infinity();
    const std::vector<float> weights = {-1, 0.5f, 0, 0, nan, 0, infinity, 0, 0, 0, 0, 0};
    const LoadedScene scene =
        makeSkinned(kJoints, kUnsignedByte, weights, kFloat).read(kMesh + kSkinNodes + kTwoJoints);
    EXPECT_EQ(primitiveOf(scene).weights, (std::vector<float>{0, 1, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}));
    EXPECT_TRUE(hasWarning(scene, "WEIGHTS_0 holds values that are below 0 or not finite"));
    EXPECT_TRUE(hasWarning(scene, "2 vertices without weight"));
}

TEST(GltfSkin, AMeshWithoutInfluencesFollowsTheFirstJoint) {
    for (const char* attributes : {"", R"(,"JOINTS_0":1)", R"(,"WEIGHTS_0":2)"}) {
        const LoadedScene scene =
            makeSkinned().read(skinnedMesh(attributes) + kSkinNodes + kTwoJoints);
        EXPECT_TRUE(hasWarning(scene, "that follows the first joint"));
        EXPECT_EQ(hasWarning(scene, "_0 without "), *attributes != '\0');
        const scene::Primitive& primitive = primitiveOf(scene);
        EXPECT_EQ(primitive.influenceCount, 4u);
        EXPECT_EQ(primitive.joints, std::vector<uint16_t>(12, 0));
        EXPECT_EQ(primitive.weights, (std::vector<float>{1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}));
    }
}

TEST(GltfSkin, JointsOutsideOfTheSceneMoveTheSkinButDrawNothing) {
    // 2 is a joint, 1 is its parent, 3 its sibling.
    const LoadedScene scene = makeSkinned().read(
        kMesh + R"("scenes":[{"nodes":[0]}],"nodes":[{"mesh":0,"skin":0},
        {"children":[2,3],"translation":[5,0,0],"mesh":0},{"translation":[0,1,0],"mesh":0},{}],)" +
        R"("skins":[{"joints":[2,0]}])"
    );
    const scene::World& world = scene.world;
    EXPECT_EQ(world.registry.aliveCount(), 3u);
    const auto& skinned = world.registry.get<scene::Skinned>(findSkinned(world));
    EXPECT_EQ(dvec3(scene::worldFromEntity(world, skinned.joints[0], 0.0)[3]), dvec3(5, 1, 0));
    EXPECT_FALSE(world.registry.has<scene::MeshInstance>(skinned.joints[0]));
}

TEST(GltfSkin, InverseBindMatricesAreReadColumnByColumn) {
    GltfFile file = makeSkinned();
    std::vector<float> matrices(48, 0.0f);
    for (size_t i : {0u, 5u, 10u, 15u, 16u, 21u, 26u, 31u})
        matrices[i] = 1.0f;
    matrices[12] = 7.0f;       // x of the first's translation
    matrices[31] = 1.0000001f; // an exporter's rounding
    file.add(matrices, kFloat, "MAT4");
    const LoadedScene scene =
        file.read(kMesh + kSkinNodes + R"("skins":[{"joints":[1,2],"inverseBindMatrices":3}])");
    const scene::Skin& skin = scene.world.assets.skins.at(0);
    ASSERT_EQ(skin.jointFromBind.size(), 2u) << "the third belongs to no joint";
    EXPECT_EQ(skin.jointFromBind[0], glm::translate(dmat4(1.0), dvec3(7, 0, 0)));
    EXPECT_EQ(skin.jointFromBind[1], dmat4(1.0));
}

const std::string kBoundSkin = R"("skins":[{"joints":[1,2],"inverseBindMatrices":3}])";

TEST(GltfSkin, InverseBindMatricesThatFitNoJointAreRefused) {
    std::vector<float> identity(16, 0.0f);
    for (const size_t i : {0u, 5u, 10u, 15u})
        identity[i] = 1.0f;
    const auto load = [&](const std::vector<float>& numbers, const char* type = "MAT4") {
        GltfFile file = makeSkinned();
        file.add(numbers, kFloat, type);
        return file.load(kMesh + kSkinNodes + kBoundSkin);
    };
    expectRefused(load(identity), "skins[0].inverseBindMatrices has 1 element for 2 joints");
    std::vector<float> two = identity;
    two.insert(two.end(), identity.begin(), identity.end());
    expectLoads(load(two));
    for (const float bad : {std::numeric_limits<float>::quiet_NaN(), 2e30f}) {
        std::vector<float> damaged = two;
        damaged[20] = bad;
        expectRefused(load(damaged), "skins[0].inverseBindMatrices[1] holds");
    }
    std::vector<float> projective = two;
    projective[3] = 0.5f;
    expectRefused(load(projective), "inverseBindMatrices[0] does not have 0 0 0 1");
    expectRefused(load(std::vector<float>(32, 0.0f)), "does not have 0 0 0 1");
    expectRefused(load(std::vector<float>(8), "VEC4"), "inverseBindMatrices: accessors[3].type");
}

TEST(GltfSkin, InverseBindMatricesWithoutABufferViewAreZeros) {
    GltfFile file = makeSkinned();
    file.addAccessor(R"({"componentType":5126,"count":2,"type":"MAT4"})");
    const std::string unskinned = R"("scenes":[{"nodes":[0,1]}],"nodes":[{"mesh":0},
        {"children":[2]},{}],)";
    (void)file.read(kMesh + unskinned + kBoundSkin); // of a skin that no node uses
    const LoadedScene scene = file.read(kMesh + kSkinNodes + kBoundSkin);
    EXPECT_TRUE(hasWarning(scene, "skins[0].inverseBindMatrices has no bufferView"));
    dmat4 collapsed(0.0);
    collapsed[3][3] = 1.0;
    EXPECT_EQ(scene.world.assets.skins.at(0).jointFromBind.at(1), collapsed);
}

TEST(GltfSkin, DamagedInfluencesAreRefused) {
    GltfFile file = makeSkinned();
    file.add(std::vector<float>(8), kFloat, "VEC4");
    const auto load = [&](const std::string& members) { return file.load(members); };
    const auto mesh = [](const char* attributes) {
        return skinnedMesh(attributes) + kSkinNodes + kTwoJoints;
    };
    expectEachRefused(
        load,
        {{kMesh + kSkinNodes + R"("skins":[{"joints":[1]}])", "names joint 1, but skins[0] has 1"},
         {kMesh + kSkinNodes + R"("skins":[{"joints":[]}])", "joints is empty"},
         {mesh(R"(,"JOINTS_0":2,"WEIGHTS_0":2)"), "componentType 5126"},
         {mesh(R"(,"JOINTS_0":1,"WEIGHTS_0":1)"), "not normalized"},
         {mesh(R"(,"JOINTS_0":1,"WEIGHTS_0":3)"),
          "meshes[0].primitives[0] WEIGHTS_0 has 2 elements, POSITION has 3"}}
    );
}

TEST(GltfSkin, ManyNodesOfOneHugeSkinMayNotFillTheMemory) {
    std::string joints = "1";
    for (int i = 1; i < 30000; ++i)
        joints += ",1";
    std::string roots = "0,1";
    std::string nodes = R"({"mesh":0,"skin":0},{})";
    for (int i = 2; i < 20000; ++i) {
        roots += fmt::format(",{}", i);
        nodes += R"(,{"mesh":0,"skin":0})";
    }
    const std::string members = R"("scenes":[{"nodes":[)" + roots + R"(]}],"nodes":[)" + nodes +
                                R"(],"skins":[{"joints":[)" + joints + "]}]";
    expectRefused(makeSkinned().load(kMesh + members), "4 GiB");
}

const std::vector<float> kUp = {0, 0, 1, 0, 0, 1, 0, 0, 1};
const std::vector<float> kDeltas = {0, 0, 0, 0, 2, 0, 0, 0, 3};

/// Accessor 0: a triangle; 1: its normals; 2: deltas.
GltfFile makeMorphFile() {
    GltfFile file;
    file.add(kTriangle, kFloat, "VEC3");
    file.add(kUp, kFloat, "VEC3");
    file.add(kDeltas, kFloat, "VEC3");
    return file;
}

std::string morphMesh(
    const std::string& targets, const std::string& attributes = R"("POSITION":0,"NORMAL":1)"
) {
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

TEST(GltfMorph, TargetsHoldWhatTheyMoveAndASparseOneOnlyTheVerticesItNames) {
    const LoadedScene scene =
        makeMorphFile().read(morphMesh(R"({"POSITION":2},{"POSITION":2,"NORMAL":2},{})"));
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
    GltfFile file = makeMorphFile();
    const int indices = file.addView(std::vector<uint16_t>{2});
    const int values = file.addView(std::vector<float>{0, 0, 9});
    file.addAccessor(fmt::format(
        R"({{"componentType":5126,"count":3,"type":"VEC3","sparse":{{"count":1,
        "indices":{{"bufferView":{},"componentType":5123}},"values":{{"bufferView":{}}}}}}})",
        indices,
        values
    ));
    const LoadedScene loaded = file.read(morphMesh(R"({"POSITION":3})"));
    const std::vector<vec3> third = {vec3(0), vec3(0), vec3(0, 0, 9)};
    EXPECT_EQ(primitiveOf(loaded).morphTargets.at(0).positions, third);
}

TEST(GltfMorph, QuantizedTargetsNeedTheExtension) {
    GltfFile file = makeMorphFile();
    file.add(std::vector<int8_t>{0, 0, 0, 127, 0, 0, 0, -128, 0}, kByte, "VEC3", true);
    const std::string members = morphMesh(R"({"POSITION":3})");
    expectRefused(file.load(members), "targets[0].POSITION: accessors[3].componentType 5120");
    const LoadedScene scene = file.read(R"("extensionsUsed":["KHR_mesh_quantization"],)" + members);
    const std::vector<vec3> deltas = {vec3(0), vec3(1, 0, 0), vec3(0, -1, 0)};
    EXPECT_EQ(primitiveOf(scene).morphTargets.at(0).positions, deltas);
}

TEST(GltfMorph, TargetsFollowVerticesThatTheLoaderDoublesOrRemoves) {
    GltfFile file;
    const float nan = std::numeric_limits<float>::quiet_NaN();
    file.add(std::vector<float>{nan, 0, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0}, kFloat, "VEC3");
    file.add(std::vector<float>{9, 9, 9, 1, 0, 0, 2, 0, 0, 3, 0, 0, 4, 0, 0}, kFloat, "VEC3");
    file.add(std::vector<uint16_t>{0, 1, 2, 1, 2, 3, 3, 2, 4}, kUnsignedShort, "SCALAR");
    const LoadedScene scene =
        file.read(R"("meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":2,
        "targets":[{"POSITION":1,"NORMAL":1}]}]}])");
    const scene::MorphTarget& target = primitiveOf(scene).morphTargets.at(0);
    ASSERT_EQ(target.positions.size(), 6u);
    const std::vector<float> expected = {1, 2, 3, 3, 2, 4};
    for (size_t i = 0; i < 6; ++i)
        EXPECT_EQ(target.positions[i].x, expected[i]);
    EXPECT_TRUE(target.normals.empty()) << "there are no normals they could be added to";
}

TEST(GltfMorph, DeltasThatAreNotFiniteAreZero) {
    GltfFile file = makeMorphFile();
    const float infinity = std::numeric_limits<float>::infinity();
    file.add(std::vector<float>{0, infinity, 0, 1, 1, 1, 0, 0, 0}, kFloat, "VEC3");
    const LoadedScene scene = file.read(morphMesh(R"({"POSITION":3})"));
    EXPECT_EQ(primitiveOf(scene).morphTargets.at(0).positions[0], vec3(0));
    EXPECT_EQ(primitiveOf(scene).morphTargets.at(0).positions[1], vec3(1));
    EXPECT_TRUE(hasWarning(scene, "targets[0].POSITION holds values that are not finite"));
}

TEST(GltfMorph, TangentsMoveOnlyWhereTheMeshGivesSome) {
    GltfFile file = makeMorphFile();
    file.add(std::vector<float>{1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1}, kFloat, "VEC4");
    file.add(std::vector<float>{0, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1}, kFloat, "VEC4");
    const std::string target = R"({"TANGENT":2})";
    const std::string attributes = R"("POSITION":0,"NORMAL":1,"TANGENT":)";
    const LoadedScene given = file.read(morphMesh(target, attributes + "3"));
    EXPECT_EQ(primitiveOf(given).morphTargets.at(0).tangents.size(), 3u);
    const LoadedScene broken = file.read(morphMesh(target, attributes + "4"));
    EXPECT_TRUE(primitiveOf(broken).morphTargets.at(0).tangents.empty());
    EXPECT_TRUE(primitiveOf(file.read(morphMesh(target))).morphTargets.at(0).tangents.empty());
}

TEST(GltfMorph, TargetsThatDoNotFitAreRefusedAndOtherAttributesIgnoredWithAWarning) {
    GltfFile file = makeMorphFile();
    file.add(std::vector<float>{0, 0, 1}, kFloat, "VEC3");
    const LoadedScene scene = file.read(morphMesh(R"({"POSITION":2,"COLOR_0":2})"));
    EXPECT_TRUE(hasWarning(scene, "morph targets of COLOR_0 are ignored"));
    expectEachRefused(
        [&](const std::string& target) { return file.load(morphMesh(target)); },
        {{R"({"POSITION":3})", "targets[0].POSITION has 1 element, POSITION has 3"},
         {R"({"TEXCOORD_0":3})", "targets[0].TEXCOORD_0 has 1 element,"},
         {R"({"POSITION":9})", "targets[0].POSITION is 9"}}
    );
    expectRefused(
        file.load(R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}},
            {"attributes":{"POSITION":0},"targets":[{"POSITION":2}]}]}])"),
        "meshes[0].primitives[1].targets has 1 morph target, primitives[0] has 0"
    );
}

TEST(GltfMorph, TheNodesWeightsGoBeforeTheMeshs) {
    const GltfFile file = makeMorphFile();
    EXPECT_EQ(weightsOf(file.read(weightedMesh(""))).weights, (std::vector<float>{0, 0}));
    const LoadedScene ofMesh = file.read(weightedMesh(R"(,"weights":[0.5,-1])"));
    EXPECT_EQ(weightsOf(ofMesh).weights, (std::vector<float>{0.5f, -1}));
    EXPECT_EQ(ofMesh.world.assets.meshes[0].morphWeights, (std::vector<float>{0.5f, -1}));
    const LoadedScene ofNode =
        file.read(weightedMesh(R"(,"weights":[0.5,-1])", R"(,"weights":[2,3])"));
    EXPECT_EQ(weightsOf(ofNode).weights, (std::vector<float>{2, 3}));
    EXPECT_EQ(ofNode.world.assets.meshes[0].morphWeights, (std::vector<float>{0.5f, -1}));
}

TEST(GltfMorph, WeightsThatDoNotFitAreRefused) {
    expectEachRefused(
        [](const std::string& members) { return makeMorphFile().load(members); },
        {{weightedMesh(R"(,"weights":[1])"),
          "meshes[0].weights has 1 number, but the mesh has 2 morph targets"},
         {weightedMesh("", R"(,"weights":[1,2,3])"), "nodes[0].weights has 3 numbers"},
         {weightedMesh("", R"(,"weights":[1,1e31])"), "nodes[0].weights holds"}}
    );
}

/// Two morph targets; accessor 3: times 0 and 1; 4: `values`.
template <class T>
core::Result<LoadedScene>
loadClip(const std::vector<T>& values, int type, const char* interpolation) {
    GltfFile file = makeMorphFile();
    file.add(std::vector<float>{0, 1}, kFloat, "SCALAR");
    file.add(values, type, "SCALAR", type != kFloat);
    return file.load(
        weightedMesh("") +
        fmt::format(
            R"(,"animations":[{{"channels":[{{"sampler":0,"target":{{"node":0,"path":"weights"}}}}],
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

TEST(GltfMorph, WeightsOfClipsComeAsStepsSplinesAndIntegersTooAndOnlyAsManyAsFit) {
    const auto read = [](const auto& values, int type, const char* interpolation) {
        const LoadedScene scene = expectLoads(loadClip(values, type, interpolation));
        return scene.world.assets.clips.at(0).weightChannels.at(0);
    };
    const std::vector<float> floats(12);
    EXPECT_EQ(
        read(std::vector<float>(4), kFloat, "STEP").interpolation, scene::Interpolation::Step
    );
    EXPECT_EQ(read(floats, kFloat, "CUBICSPLINE").values.size(), 12u);
    const std::vector<uint8_t> bytes = {0, 51, 255, 0};
    const std::vector<float> shares = {0, 0.2f, 1, 0};
    EXPECT_EQ(read(bytes, kUnsignedByte, "LINEAR").values, shares);
    const auto refuse =
        [](std::vector<float> values, const char* interpolation, const char* sentence) {
            expectRefused(loadClip(values, kFloat, interpolation), sentence);
        };
    refuse({0, 1, 2}, "LINEAR", "animations[0].samplers[0] has 3 values for 2 keys, not 4");
    refuse({0, 0, 0, 0}, "CUBICSPLINE", "4 values for 2 keys, not 12");
    const float nan = std::numeric_limits<float>::quiet_NaN();
    refuse({0, nan, 0, 0}, "LINEAR", "samplers[0].output holds nan");
}

} // namespace
} // namespace shutter::gltf
