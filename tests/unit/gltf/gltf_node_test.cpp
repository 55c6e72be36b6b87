// SPDX-License-Identifier: MIT
// The hierarchy, cameras, lights and velocities.
#include "engine/gltf/gltf_parts.h"
#include "tests/unit/gltf/gltf_fixture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace shutter::gltf {

namespace {

using math::dmat4;
using math::dquat;
using math::dvec3;

/// A file of `nodes` whose scene lists `roots`.
core::Result<LoadedScene>
loadNodesOf(const std::string& nodes, const std::string& roots = "0", std::string rest = "") {
    if (!rest.empty())
        rest = "," + rest;
    return loadMembers(
        fmt::format(R"("scenes":[{{"nodes":[{}]}}],"nodes":[{}]{})", roots, nodes, rest)
    );
}

ecs::Entity findNamed(const scene::World& world, const std::string& name) {
    for (const auto& [entity, component] : world.registry.view<const scene::Name>()) {
        if (component.value == name)
            return entity;
    }
    ADD_FAILURE() << "no entity " << name;
    return ecs::kNullEntity;
}

void expectNear(const dvec3& actual, const dvec3& expected) {
    EXPECT_NEAR(glm::distance(actual, expected), 0.0, 1e-9)
        << actual.x << " " << actual.y << " " << actual.z;
}

TEST(GltfNode, NodesBecomeEntitiesWithNamesParentsAndTransforms) {
    const LoadedScene scene = expectLoads(loadNodesOf(
        R"({"name":"a","children":[1],"translation":[1,2,3],"rotation":[0,0,2,0],
            "scale":[1,-2,0]},{"name":"b"})"
    ));
    const ecs::Registry& registry = scene.world.registry;
    EXPECT_EQ(registry.aliveCount(), 2u);
    const ecs::Entity a = findNamed(scene.world, "a");
    const ecs::Entity b = findNamed(scene.world, "b");
    EXPECT_FALSE(registry.has<scene::Parent>(a));
    EXPECT_EQ(registry.get<scene::Parent>(b).entity, a);
    const math::Transform& transform = registry.get<scene::LocalTransform>(a).transform;
    expectNear(transform.translation, {1, 2, 3});
    expectNear(transform.scale, {1, -2, 0});
    EXPECT_EQ(transform.rotation, dquat(0, 0, 0, 1)) << "unit length";
    EXPECT_TRUE(registry.has<scene::LocalTransform>(b));
}

TEST(GltfNode, OnlyTheDefaultSceneBecomesEntities) {
    const auto load = [](const std::string& scene) {
        return expectLoads(loadMembers(scene + R"("scenes":[{"nodes":[0]},{"nodes":[1]}],
            "nodes":[{"name":"a"},{"name":"b","children":[2]},{"name":"c"},{"name":"d"}])"));
    };
    EXPECT_EQ(load("").world.registry.aliveCount(), 1u);
    EXPECT_EQ(load(R"("scene":0,)").world.registry.aliveCount(), 1u);
    const LoadedScene second = load(R"("scene":1,)");
    EXPECT_EQ(second.world.registry.aliveCount(), 2u);
    EXPECT_NE(findNamed(second.world, "c"), ecs::kNullEntity);
}

TEST(GltfNode, AFileWithoutScenesDrawsNothingAndSaysSo) {
    const LoadedScene scene = expectLoads(loadMembers(R"("nodes":[{}])"));
    EXPECT_EQ(scene.world.registry.aliveCount(), 0u);
    EXPECT_TRUE(hasWarning(scene, "no scene"));
}

TEST(GltfNode, CyclesTwoParentsAndRepeatedRootsAreRefused) {
    expectRefused(loadNodesOf(R"({"children":[0]})"), "nodes[0] is its own ancestor");
    expectRefused(loadNodesOf(R"({},{"children":[2]},{"children":[1]})"), "its own ancestor");
    expectRefused(loadNodesOf(R"({"children":[2]},{"children":[2]},{})"), "is a child of");
    expectRefused(loadNodesOf(R"({"children":[1,1]},{})"), "is a child of");
    expectRefused(loadNodesOf("{}", "0,0"), "twice");
    expectRefused(loadNodesOf(R"({"children":[1]},{})", "1"), "which is a child of");
}

TEST(GltfNode, AChainOfFiftyThousandNodesLoads) {
    std::string nodes;
    for (int i = 1; i < 50000; ++i)
        nodes += fmt::format(R"({{"children":[{}]}},)", i);
    const LoadedScene scene = expectLoads(loadNodesOf(nodes + "{}"));
    EXPECT_EQ(scene.world.registry.aliveCount(), 50000u);
}

TEST(GltfNode, TransformsWithoutMeaningAreRefused) {
    expectRefused(loadNodesOf(R"({"rotation":[0,0,0,0]})"), "nodes[0].rotation has no length");
    expectRefused(loadNodesOf(R"({"translation":[1e31,0,0]})"), "nodes[0].translation");
    expectRefused(loadNodesOf(R"({"scale":[1e309,0,0]})"), "does not parse");
    expectRefused(
        loadNodesOf(R"({"matrix":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,0]})"), "0 0 0 1 as its last row"
    );
    expectRefused(loadNodesOf(R"({"matrix":[1,0,0]})"), "has 3 numbers, not 16");
}

TEST(GltfNode, AMatrixBecomesTranslationRotationAndScale) {
    const LoadedScene scene =
        expectLoads(loadNodesOf(R"({"name":"a","matrix":[0,2,0,0,-3,0,0,0,0,0,4,0,5,6,7,1]})"));
    const ecs::Entity a = findNamed(scene.world, "a");
    const auto* local = scene.world.registry.find<scene::LocalTransform>(a);
    ASSERT_NE(local, nullptr);
    EXPECT_FALSE(scene.world.registry.has<scene::LocalMatrix>(a));
    expectNear(local->transform.translation, {5, 6, 7});
    expectNear(local->transform.scale, {2, 3, 4});
    expectNear(local->transform.rotation * dvec3(1, 0, 0), {0, 1, 0});
}

TEST(GltfNode, AMatrixThatShearsStaysAMatrix) {
    const LoadedScene scene =
        expectLoads(loadNodesOf(R"({"name":"a","matrix":[1,0,0,0,1,1,0,0,0,0,1,0,0,0,0,1]})"));
    const ecs::Entity a = findNamed(scene.world, "a");
    EXPECT_FALSE(scene.world.registry.has<scene::LocalTransform>(a));
    EXPECT_EQ(scene.world.registry.get<scene::LocalMatrix>(a).matrix[1][0], 1.0);
}

TEST(DecomposeMatrix, AMirrorBecomesANegativeScaleThatRebuildsTheMatrix) {
    dmat4 matrix(1.0);
    matrix[2][2] = -2.0;
    const auto transform = decomposeMatrix(matrix);
    ASSERT_TRUE(transform.has_value());
    EXPECT_LT(transform->scale.x * transform->scale.y * transform->scale.z, 0.0);
    for (const dvec3 point : {dvec3(1, 0, 0), dvec3(0, 1, 0), dvec3(0, 0, 1)}) {
        expectNear(
            transform->rotation * (transform->scale * point), dvec3(matrix * glm::dvec4(point, 0))
        );
    }
}

TEST(DecomposeMatrix, AFlattenedAxisHasNoRotationToFind) {
    dmat4 matrix(1.0);
    matrix[1] = glm::dvec4(0.0);
    EXPECT_FALSE(decomposeMatrix(matrix).has_value());
    EXPECT_FALSE(decomposeMatrix(dmat4(0.0)).has_value());
    EXPECT_TRUE(decomposeMatrix(dmat4(1.0)).has_value());
}

TEST(GltfNode, MeshesAreInstancedByIndex) {
    GltfFile file;
    file.add(kTriangle, kFloat, "VEC3");
    const LoadedScene scene = expectLoads(file.load(
        R"("meshes":[{"primitives":[]},{"name":"m","primitives":[{"attributes":{"POSITION":0}}]}],)"
        R"("scenes":[{"nodes":[0,1]}],"nodes":[{"name":"a","mesh":1},{"name":"b"}])"
    ));
    const ecs::Entity a = findNamed(scene.world, "a");
    EXPECT_EQ(scene.world.registry.get<scene::MeshInstance>(a).mesh, 1u);
    EXPECT_FALSE(scene.world.registry.has<scene::MeshInstance>(findNamed(scene.world, "b")));
    EXPECT_EQ(scene.world.assets.meshes[1].name, "m");
}

TEST(GltfNode, CamerasAreListedInNodeOrder) {
    const LoadedScene scene = expectLoads(loadNodesOf(
        R"({"name":"ortho","camera":1},{"camera":0},{})",
        "2,1,0",
        R"("cameras":[{"name":"main","type":"perspective","perspective":{"yfov":0.7,"znear":0.1}},
            {"type":"orthographic","orthographic":{"xmag":2,"ymag":3,"znear":0,"zfar":9}}])"
    ));
    ASSERT_EQ(scene.world.cameras.size(), 2u);
    const auto& ortho = scene.world.registry.get<scene::Camera>(scene.world.cameras[0]);
    EXPECT_EQ(ortho.kind, scene::CameraKind::Orthographic);
    EXPECT_EQ(ortho.xMag, 2.0);
    EXPECT_EQ(ortho.yMag, 3.0);
    EXPECT_EQ(ortho.near, 0.0);
    EXPECT_EQ(ortho.far, 9.0);
    const auto& perspective = scene.world.registry.get<scene::Camera>(scene.world.cameras[1]);
    EXPECT_EQ(perspective.kind, scene::CameraKind::Perspective);
    EXPECT_EQ(perspective.yFov, 0.7);
    EXPECT_EQ(perspective.near, 0.1);
    EXPECT_EQ(scene.world.cameras[0], findNamed(scene.world, "ortho"));
    EXPECT_EQ(scene.world.cameras[1], findNamed(scene.world, "main")) << "the camera's own name";
}

TEST(GltfNode, FramesOfCamerasAreReadMirroredOnesToo) {
    const LoadedScene scene = expectLoads(loadNodesOf(
        R"({"camera":0},{"camera":1},{"camera":2})",
        "0,1,2",
        R"("cameras":[
            {"type":"perspective","perspective":{"yfov":0.7,"znear":0.1,"aspectRatio":2.39}},
            {"type":"perspective","perspective":{"yfov":0.7,"znear":0.1}},
            {"type":"orthographic","orthographic":{"xmag":-2,"ymag":-3,"znear":0,"zfar":9}}])"
    ));
    const auto camera = [&](size_t i) {
        return scene.world.registry.get<scene::Camera>(scene.world.cameras[i]);
    };
    EXPECT_EQ(camera(0).aspectRatio, 2.39);
    EXPECT_FALSE(camera(1).aspectRatio);
    EXPECT_EQ(camera(2).xMag, -2.0);
    EXPECT_EQ(camera(2).yMag, -3.0);
}

TEST(GltfNode, CamerasNoPictureCanBeTakenWithAreRefused) {
    const auto load = [](const std::string& camera) {
        return loadNodesOf(R"({"camera":0})", "0", R"("cameras":[)" + camera + "]");
    };
    const auto perspective = [&](const char* values) {
        return load(fmt::format(R"({{"type":"perspective","perspective":{{{}}}}})", values));
    };
    expectLoads(perspective(R"("yfov":1,"znear":0.1)"));
    expectRefused(perspective(R"("yfov":3.2,"znear":0.1)"), "yfov is 3.2");
    expectRefused(perspective(R"("yfov":0,"znear":0.1)"), "yfov is 0");
    expectRefused(perspective(R"("yfov":1,"znear":0)"), "znear is 0");
    expectRefused(perspective(R"("yfov":1)"), "znear is missing");
    expectRefused(load(R"({"type":"fisheye"})"), "'fisheye'");
    for (const char* wrong : {"-1.5", "1e31"})
        expectRefused(
            perspective(fmt::format(R"("yfov":1,"znear":0.1,"aspectRatio":{})", wrong).c_str()),
            "aspectRatio is"
        );
    expectRefused(
        load(R"({"type":"orthographic","orthographic":{"xmag":1,"ymag":-1e31,"znear":0,"zfar":1}})"
        ),
        "ymag is -1e+31"
    );
    expectRefused(
        load(R"({"type":"orthographic","orthographic":{"xmag":0,"ymag":1,"znear":0,"zfar":1}})"),
        "xmag is 0"
    );
    expectRefused(
        load(R"({"type":"orthographic","orthographic":{"xmag":1,"ymag":1,"znear":1,"zfar":1}})"),
        "zfar is 1"
    );
}

core::Result<LoadedScene> loadLight(const std::string& light, int index = 0) {
    return loadNodesOf(
        fmt::format(
            R"({{"name":"l","extensions":{{"KHR_lights_punctual":{{"light":{}}}}}}})", index
        ),
        "0",
        R"("extensions":{"KHR_lights_punctual":{"lights":[)" + light + "]}}"
    );
}

scene::Light readLight(const std::string& json) {
    const LoadedScene scene = expectLoads(loadLight(json));
    return scene.world.registry.get<scene::Light>(findNamed(scene.world, "l"));
}

TEST(GltfNode, LightsOfAllKindsAreRead) {
    const scene::Light sun = readLight(R"({"type":"directional","intensity":3,"color":[1,0.5,0]})");
    EXPECT_EQ(sun.kind, scene::LightKind::Directional);
    EXPECT_EQ(sun.intensity, 3.0f);
    EXPECT_EQ(sun.color, math::vec3(1.0f, 0.5f, 0.0f));
    const scene::Light point = readLight(R"({"type":"point"})");
    EXPECT_EQ(point.kind, scene::LightKind::Point);
    EXPECT_EQ(point.intensity, 1.0f);
    EXPECT_TRUE(std::isinf(point.range));
    const scene::Light spot =
        readLight(R"({"type":"spot","range":5,"spot":{"innerConeAngle":0.1,"outerConeAngle":0.2}})"
        );
    EXPECT_EQ(spot.kind, scene::LightKind::Spot);
    EXPECT_EQ(spot.range, 5.0f);
    EXPECT_EQ(spot.innerConeAngle, 0.1f);
    EXPECT_EQ(spot.outerConeAngle, 0.2f);
}

TEST(GltfNode, MalformedLightsAreRefused) {
    expectRefused(loadLight(R"({"type":"point"})", 1), "light is 1, but there is 1 light");
    expectRefused(loadLight(R"({"type":"point"})", -1), "light is -1");
    expectRefused(loadLight(R"({"type":"laser"})"), "'laser'");
    expectRefused(loadLight(R"({"type":"point","intensity":-1})"), "intensity is -1");
    expectRefused(loadLight(R"({"type":"point","color":[1]})"), "color has 1");
    expectRefused(loadLight(R"({"type":"spot","spot":{"innerConeAngle":1}})"), "cone angles");
}

TEST(GltfNode, VelocitiesTurnFromNodeSpaceToTheParents) {
    // Rotated by 90 degrees about +z: the node's +x is the parent's +y. The scale does not count.
    const LoadedScene scene = expectLoads(loadNodesOf(
        R"({"name":"a","rotation":[0,0,0.7071067811865476,0.7071067811865476],"scale":[9,9,9],
            "extensions":{"KHR_physics_rigid_bodies":{"motion":{"mass":2,
                "linearVelocity":[3,0,0],"angularVelocity":[0,5,0]},"collider":{}}}})"
    ));
    const ecs::Entity a = findNamed(scene.world, "a");
    expectNear(scene.world.registry.get<scene::LinearVelocity>(a).metresPerSecond, {0, 3, 0});
    expectNear(scene.world.registry.get<scene::AngularVelocity>(a).radiansPerSecond, {-5, 0, 0});
}

TEST(GltfNode, AMotionWithoutVelocitiesAddsNone) {
    const LoadedScene scene = expectLoads(loadNodesOf(
        R"({"name":"a","extensions":{"KHR_physics_rigid_bodies":{"motion":{"mass":2}}}})"
    ));
    const ecs::Entity a = findNamed(scene.world, "a");
    EXPECT_FALSE(scene.world.registry.has<scene::LinearVelocity>(a));
    EXPECT_FALSE(scene.world.registry.has<scene::AngularVelocity>(a));
    expectRefused(
        loadNodesOf(
            R"({"extensions":{"KHR_physics_rigid_bodies":{"motion":{"linearVelocity":[1]}}}})"
        ),
        "motion.linearVelocity is not an array of 3"
    );
}

} // namespace

} // namespace shutter::gltf
