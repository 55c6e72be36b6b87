// SPDX-License-Identifier: MIT
// EXT_mesh_gpu_instancing: one entity an instance.
#include "engine/scene/motion.h"
#include "tests/unit/gltf/gltf_fixture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace shutter::gltf {

namespace {

using math::dmat4;
using math::dvec3;
using math::dvec4;

/// Accessor 0: a triangle; 1: two places; 2: two rotations; 3: two scales; 4: three numbers.
GltfFile makeFile(
    const std::vector<float>& translations = {1, 0, 0, 0, 5, 0},
    const std::vector<float>& rotations = {0, 0, 0, 1, 0, 0, 2, 0}
) {
    GltfFile file;
    file.add(kTriangle, kFloat, "VEC3");
    file.add(translations, kFloat, "VEC3");
    file.add(rotations, kFloat, "VEC4");
    file.add(std::vector<float>{1, 1, 1, 2, 3, 4}, kFloat, "VEC3");
    file.add(std::vector<float>{7, 8, 9}, kFloat, "SCALAR");
    return file;
}

/// Node 0 with the instances; `rest` are more members of the file.
std::string members(
    const std::string& attributes,
    const std::string& node = R"("mesh":0,"translation":[10,0,0])",
    const std::string& rest = ""
) {
    return R"("extensionsRequired":["EXT_mesh_gpu_instancing"],
        "extensionsUsed":["EXT_mesh_gpu_instancing"],
        "meshes":[{"primitives":[{"attributes":{"POSITION":0},"targets":[{"POSITION":0}]}]}],
        "scenes":[{"nodes":[0]}],"nodes":[{)" +
           node + R"(,"extensions":{"EXT_mesh_gpu_instancing":{)" + attributes + "}}}]" + rest;
}

std::string attributes(const std::string& list) {
    return R"("attributes":{)" + list + "}";
}

const std::string kAll = attributes(R"("TRANSLATION":1,"ROTATION":2,"SCALE":3)");

std::vector<ecs::Entity> findDrawn(const scene::World& world) {
    std::vector<ecs::Entity> found;
    for (const auto& [entity, instance] : world.registry.view<const scene::MeshInstance>())
        found.push_back(entity);
    return found;
}

TEST(GltfInstancing, EachInstanceIsAnEntityBelowTheNode) {
    const LoadedScene scene = expectLoads(makeFile().load(members(kAll)));
    EXPECT_TRUE(scene.warnings.empty());
    const scene::World& world = scene.world;
    EXPECT_EQ(world.registry.aliveCount(), 3u) << "the node itself stays, but draws nothing";
    const std::vector<ecs::Entity> drawn = findDrawn(world);
    ASSERT_EQ(drawn.size(), 2u);
    const dmat4 first = scene::worldFromEntity(world, drawn[0], 0.0);
    EXPECT_EQ(dvec3(first * dvec4(1, 0, 0, 1)), dvec3(12, 0, 0));
    const dmat4 second = scene::worldFromEntity(world, drawn[1], 0.0);
    const dvec3 turned(second * dvec4(1, 1, 1, 1)); // half a turn about z of (2, 3, 4)
    EXPECT_NEAR(turned.x, 8.0, 1e-12);
    EXPECT_NEAR(turned.y, 2.0, 1e-12);
    EXPECT_NEAR(turned.z, 4.0, 1e-12);
}

TEST(GltfInstancing, WhatIsNotGivenIsTheIdentityAndOtherAttributesOnlyCount) {
    const LoadedScene placed =
        expectLoads(makeFile().load(members(attributes(R"("TRANSLATION":1)"))));
    ASSERT_EQ(findDrawn(placed.world).size(), 2u);
    const dmat4 second = scene::worldFromEntity(placed.world, findDrawn(placed.world)[1], 0.0);
    EXPECT_EQ(second, glm::translate(dmat4(1.0), dvec3(10, 5, 0)));
    const LoadedScene ids = expectLoads(makeFile().load(members(attributes(R"("_ID":4)"))));
    EXPECT_EQ(findDrawn(ids.world).size(), 3u);
}

TEST(GltfInstancing, RotationsComeAsNormalizedIntegersToo) {
    GltfFile file = makeFile();
    file.add(std::vector<int8_t>{0, 0, 127, 0, 0, 0, 0, 127}, kByte, "VEC4", true);
    const LoadedScene scene =
        expectLoads(file.load(members(attributes(R"("TRANSLATION":1,"ROTATION":5)"))));
    const auto& local =
        scene.world.registry.get<scene::LocalTransform>(findDrawn(scene.world).at(0));
    EXPECT_NEAR(std::abs(local.transform.rotation.z), 1.0, 1e-12);
}

TEST(GltfInstancing, InstancesMoveWithTheirNodeAndMorphLikeIt) {
    GltfFile file = makeFile();
    file.add(std::vector<float>{0, 1}, kFloat, "SCALAR");
    file.add(std::vector<float>{0, 0, 0, 100, 0, 0}, kFloat, "VEC3");
    file.add(std::vector<float>{0, 1}, kFloat, "SCALAR");
    const LoadedScene scene = expectLoads(file.load(members(
        kAll,
        R"("mesh":0,"weights":[0.5])",
        R"(,"animations":[{"channels":[{"sampler":0,"target":{"node":0,"path":"translation"}},
            {"sampler":1,"target":{"node":0,"path":"weights"}}],
            "samplers":[{"input":5,"output":6},{"input":5,"output":7}]}])"
    )));
    const scene::World& world = scene.world;
    const std::vector<ecs::Entity> drawn = findDrawn(world);
    ASSERT_EQ(drawn.size(), 2u);
    for (const ecs::Entity entity : drawn) {
        EXPECT_TRUE(scene::mayMove(world, entity));
        const auto& morph = world.registry.get<scene::MorphWeights>(entity);
        EXPECT_EQ(morph.weights, std::vector<float>{0.5f});
        EXPECT_EQ(morph.channels.size(), 1u);
    }
    const dmat4 moved = scene::worldFromEntity(world, drawn[0], 1.0);
    EXPECT_EQ(dvec3(moved[3]), dvec3(101, 0, 0));
    std::vector<ecs::Entity> morphed;
    for (const auto& [entity, morph] : world.registry.view<const scene::MorphWeights>())
        morphed.push_back(entity);
    EXPECT_EQ(morphed, drawn) << "the node itself draws nothing that could be morphed";
}

TEST(GltfInstancing, ANodeWithoutAMeshHasNoInstances) {
    const LoadedScene scene = expectLoads(makeFile().load(members(kAll, R"("name":"empty")")));
    EXPECT_EQ(scene.world.registry.aliveCount(), 1u);
}

TEST(GltfInstancing, ASkinnedNodeIsDrawnOnce) {
    const LoadedScene scene = expectLoads(
        makeFile().load(members(kAll, R"("mesh":0,"skin":0)", R"(,"skins":[{"joints":[0]}])"))
    );
    EXPECT_EQ(findDrawn(scene.world).size(), 1u);
    EXPECT_TRUE(hasWarning(scene, "EXT_mesh_gpu_instancing is ignored"));
}

TEST(GltfInstancing, RotationsWithoutABufferViewTurnNothing) {
    GltfFile file = makeFile();
    file.addAccessor(R"({"componentType":5126,"count":2,"type":"VEC4"})");
    const LoadedScene scene = expectLoads(file.load(members(attributes(R"("ROTATION":5)"))));
    EXPECT_EQ(findDrawn(scene.world).size(), 2u);
    EXPECT_TRUE(hasWarning(scene, "ROTATION has no bufferView"));
}

TEST(GltfInstancing, DamagedInstancesAreRefused) {
    const auto load = [](const std::string& extension) {
        return makeFile().load(members(extension));
    };
    const std::string at = "nodes[0].extensions.EXT_mesh_gpu_instancing.attributes";
    expectRefused(load(""), at + " is missing or empty");
    expectRefused(load(attributes("")), at + " is missing or empty");
    expectRefused(load(R"("attributes":[1])"), at + " is missing or empty");
    expectRefused(load(attributes(R"("TRANSLATION":"1")")), at + ".TRANSLATION is not a number");
    expectRefused(load(attributes(R"("TRANSLATION":1.5)")), "not an index");
    expectRefused(
        load(attributes(R"("TRANSLATION":99)")), "TRANSLATION is 99, but there are 5 accessors"
    );
    expectRefused(load(attributes(R"("TRANSLATION":1,"_ID":4)")), "has 3 instances, others have 2");
    expectRefused(load(attributes(R"("TRANSLATION":2)")), "TRANSLATION: accessors[2].type");
    for (const float bad : {std::numeric_limits<float>::quiet_NaN(), 2e30f}) {
        expectRefused(makeFile({1, 0, 0, 0, bad, 0}).load(members(kAll)), ".TRANSLATION holds");
    }
    expectRefused(
        makeFile({1, 0, 0, 0, 0, 0}, {0, 0, 0, 1, 0, 0, 0, 0}).load(members(kAll)),
        "ROTATION: rotation 1 has no length"
    );
}

TEST(GltfInstancing, ASmallFileMayNotAskForMoreInstancesThanMemoryHolds) {
    GltfFile file = makeFile();
    file.addAccessor(R"({"componentType":5126,"count":40000000,"type":"VEC3"})");
    expectRefused(file.load(members(attributes(R"("_ID":5)"))), "4 GiB");
}

} // namespace

} // namespace shutter::gltf
