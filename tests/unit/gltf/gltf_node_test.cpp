// SPDX-License-Identifier: MIT
// Nodes: transforms, cameras, lights, velocities, extras, EXT_mesh_gpu_instancing.
#include "engine/gltf/gltf_parts.h"
#include "engine/scene/auto_focus.h"
#include "engine/scene/motion.h"
#include "tests/support/rows.h"
#include "tests/unit/gltf/gltf_fixture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <initializer_list>
#include <limits>
#include <string>
#include <utility>

namespace shutter::gltf {
namespace {

using math::dmat4;
using math::dquat;
using math::dvec3;
using math::dvec4;

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

TEST(GltfNode, OnlyTheDefaultSceneBecomesEntitiesAndAFileWithoutScenesDrawsNothing) {
    const auto load = [](const std::string& scene) {
        return readMembers(scene + R"("scenes":[{"nodes":[0]},{"nodes":[1]}],
            "nodes":[{"name":"a"},{"name":"b","children":[2]},{"name":"c"},{"name":"d"}])");
    };
    EXPECT_EQ(load("").world.registry.aliveCount(), 1u);
    EXPECT_EQ(load(R"("scene":0,)").world.registry.aliveCount(), 1u);
    const LoadedScene second = load(R"("scene":1,)");
    EXPECT_EQ(second.world.registry.aliveCount(), 2u);
    EXPECT_NE(findNamed(second.world, "c"), ecs::kNullEntity);
    const LoadedScene scene = readMembers(R"("nodes":[{}])");
    EXPECT_EQ(scene.world.registry.aliveCount(), 0u);
    EXPECT_TRUE(hasWarning(scene, "no scene"));
}

TEST(GltfNode, TreesAndTransformsWithoutMeaningAreRefused) {
    expectEachRefused(
        [](const std::string& nodes) { return loadNodesOf(nodes); },
        {{R"({"children":[0]})", "nodes[0] is its own ancestor"},
         {R"({},{"children":[2]},{"children":[1]})", "its own ancestor"},
         {R"({"children":[2]},{"children":[2]},{})", "is a child of"},
         {R"({"children":[1,1]},{})", "is a child of"},
         {R"({"rotation":[0,0,0,0]})", "nodes[0].rotation has no length"},
         {R"({"translation":[1e31,0,0]})", "nodes[0].translation"},
         {R"({"scale":[1e309,0,0]})", "does not parse"},
         {R"({"matrix":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,0]})", "0 0 0 1 as its last row"},
         {R"({"matrix":[1,0,0]})", "has 3 numbers, not 16"},
         {R"({"extensions":{"KHR_physics_rigid_bodies":{"motion":{"linearVelocity":[1]}}}})",
          "motion.linearVelocity is not an array of 3"}}
    );
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

TEST(GltfNode, AMatrixBecomesTranslationRotationAndScaleAndOneThatShearsStays) {
    const LoadedScene scene = expectLoads(loadNodesOf(
        R"({"name":"a","matrix":[0,2,0,0,-3,0,0,0,0,0,4,0,5,6,7,1]},
        {"name":"b","matrix":[1,0,0,0,1,1,0,0,0,0,1,0,0,0,0,1]})",
        "0,1"
    ));
    const ecs::Registry& registry = scene.world.registry;
    const ecs::Entity a = findNamed(scene.world, "a");
    const auto* local = registry.find<scene::LocalTransform>(a);
    ASSERT_NE(local, nullptr);
    EXPECT_FALSE(registry.has<scene::LocalMatrix>(a));
    expectNear(local->transform.translation, {5, 6, 7});
    expectNear(local->transform.scale, {2, 3, 4});
    expectNear(local->transform.rotation * dvec3(1, 0, 0), {0, 1, 0});
    const ecs::Entity b = findNamed(scene.world, "b");
    EXPECT_FALSE(registry.has<scene::LocalTransform>(b));
    EXPECT_EQ(registry.get<scene::LocalMatrix>(b).matrix[1][0], 1.0);
}

TEST(DecomposeMatrix, AMirrorBecomesANegativeScaleAndAFlattenedAxisHasNoRotationToFind) {
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
    dmat4 flat(1.0);
    flat[1] = glm::dvec4(0.0);
    EXPECT_FALSE(decomposeMatrix(flat).has_value());
    EXPECT_FALSE(decomposeMatrix(dmat4(0.0)).has_value());
    EXPECT_TRUE(decomposeMatrix(dmat4(1.0)).has_value());
}

TEST(GltfNode, MeshesAreInstancedByIndex) {
    GltfFile file;
    file.add(kTriangle, kFloat, "VEC3");
    const LoadedScene scene = file.read(
        R"("meshes":[{"primitives":[]},{"name":"m","primitives":[{"attributes":{"POSITION":0}}]}],)"
        R"("scenes":[{"nodes":[0,1]}],"nodes":[{"name":"a","mesh":1},{"name":"b"}])"
    );
    EXPECT_EQ(scene.world.registry.get<scene::MeshInstance>(findNamed(scene.world, "a")).mesh, 1u);
    EXPECT_FALSE(scene.world.registry.has<scene::MeshInstance>(findNamed(scene.world, "b")));
    EXPECT_EQ(scene.world.assets.meshes[1].name, "m");
}

TEST(GltfNode, CamerasAreListedInNodeOrderWithTheirFramesMirroredOnesToo) {
    const LoadedScene scene = expectLoads(loadNodesOf(
        R"({"name":"ortho","camera":1},{"camera":0},{},{"camera":2},{"camera":3})",
        "2,1,0,3,4",
        R"("cameras":[{"name":"main","type":"perspective","perspective":{"yfov":0.7,"znear":0.1}},
            {"type":"orthographic","orthographic":{"xmag":2,"ymag":3,"znear":0,"zfar":9}},
            {"type":"perspective","perspective":{"yfov":0.7,"znear":0.1,"aspectRatio":2.39}},
            {"type":"orthographic","orthographic":{"xmag":-2,"ymag":-3,"znear":0,"zfar":9}}])"
    ));
    ASSERT_EQ(scene.world.cameras.size(), 4u);
    const auto camera = [&](size_t i) {
        return scene.world.registry.get<scene::Camera>(scene.world.cameras[i]);
    };
    EXPECT_EQ(camera(0).kind, scene::CameraKind::Orthographic);
    EXPECT_EQ(camera(0).xMag, 2.0);
    EXPECT_EQ(camera(0).yMag, 3.0);
    EXPECT_EQ(camera(0).near, 0.0);
    EXPECT_EQ(camera(0).far, 9.0);
    EXPECT_EQ(camera(1).kind, scene::CameraKind::Perspective);
    EXPECT_EQ(camera(1).yFov, 0.7);
    EXPECT_EQ(camera(1).near, 0.1);
    EXPECT_FALSE(camera(1).aspectRatio);
    EXPECT_EQ(camera(2).aspectRatio, 2.39);
    EXPECT_EQ(camera(3).xMag, -2.0);
    EXPECT_EQ(camera(3).yMag, -3.0);
    EXPECT_EQ(scene.world.cameras[0], findNamed(scene.world, "ortho"));
    EXPECT_EQ(scene.world.cameras[1], findNamed(scene.world, "main")) << "the camera's own name";
}

TEST(GltfNode, CamerasNoPictureCanBeTakenWithAreRefused) {
    const auto load = [](const std::string& camera) {
        return loadNodesOf(R"({"camera":0})", "0", R"("cameras":[)" + camera + "]");
    };
    const auto perspective = [&](const std::string& values) {
        return load(R"({"type":"perspective","perspective":{)" + values + "}}");
    };
    expectLoads(perspective(R"("yfov":1,"znear":0.1)"));
    expectEachRefused(
        perspective,
        {{R"("yfov":3.2,"znear":0.1)", "yfov is 3.2"},
         {R"("yfov":0,"znear":0.1)", "yfov is 0"},
         {R"("yfov":1,"znear":0)", "znear is 0"},
         {R"("yfov":1)", "znear is missing"},
         {R"("yfov":1,"znear":0.1,"aspectRatio":-1.5)", "aspectRatio is"},
         {R"("yfov":1,"znear":0.1,"aspectRatio":1e31)", "aspectRatio is"}}
    );
    expectEachRefused(
        [&](const std::string& values) {
            return load(R"({"type":"orthographic","orthographic":{)" + values + "}}");
        },
        {{R"("xmag":1,"ymag":-1e31,"znear":0,"zfar":1)", "ymag is -1e+31"},
         {R"("xmag":0,"ymag":1,"znear":0,"zfar":1)", "xmag is 0"},
         {R"("xmag":1,"ymag":1,"znear":1,"zfar":1)", "zfar is 1"}}
    );
    expectRefused(load(R"({"type":"fisheye"})"), "'fisheye'");
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

TEST(GltfNode, LightsOfAllKindsAreReadAndMalformedOnesRefused) {
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
    expectRefused(loadLight(R"({"type":"point"})", 1), "light is 1, but there is 1 light");
    expectRefused(loadLight(R"({"type":"point"})", -1), "light is -1");
    expectRefused(loadLight(R"({"type":"laser"})"), "'laser'");
    expectRefused(loadLight(R"({"type":"point","intensity":-1})"), "intensity is -1");
    expectRefused(loadLight(R"({"type":"point","color":[1]})"), "color has 1");
    expectRefused(loadLight(R"({"type":"spot","spot":{"innerConeAngle":1}})"), "cone angles");
}

TEST(GltfNode, VelocitiesTurnFromNodeSpaceToTheParentsAndAMotionWithoutAnyAddsNone) {
    // Rotated by 90 degrees about +z: the node's +x is the parent's +y. The scale does not count.
    const LoadedScene scene = expectLoads(loadNodesOf(
        R"({"name":"a","rotation":[0,0,0.7071067811865476,0.7071067811865476],"scale":[9,9,9],
            "extensions":{"KHR_physics_rigid_bodies":{"motion":{"mass":2,
                "linearVelocity":[3,0,0],"angularVelocity":[0,5,0]},"collider":{}}}})"
    ));
    const ecs::Entity a = findNamed(scene.world, "a");
    expectNear(scene.world.registry.get<scene::LinearVelocity>(a).metresPerSecond, {0, 3, 0});
    expectNear(scene.world.registry.get<scene::AngularVelocity>(a).radiansPerSecond, {-5, 0, 0});
    const LoadedScene still = expectLoads(loadNodesOf(
        R"({"name":"a","extensions":{"KHR_physics_rigid_bodies":{"motion":{"mass":2}}}})"
    ));
    const ecs::Entity b = findNamed(still.world, "a");
    EXPECT_FALSE(still.world.registry.has<scene::LinearVelocity>(b));
    EXPECT_FALSE(still.world.registry.has<scene::AngularVelocity>(b));
}

/// Accessor 0: a triangle; 1: two places; 2: two rotations; 3: two scales; 4: three numbers.
GltfFile makeInstancedFile(
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
    const LoadedScene scene = makeInstancedFile().read(members(kAll));
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

TEST(GltfInstancing, MissingAttributesAreTheIdentityAndOthersAreIgnored) {
    const LoadedScene placed = makeInstancedFile().read(members(attributes(R"("TRANSLATION":1)")));
    ASSERT_EQ(findDrawn(placed.world).size(), 2u);
    const dmat4 second = scene::worldFromEntity(placed.world, findDrawn(placed.world)[1], 0.0);
    EXPECT_EQ(second, glm::translate(dmat4(1.0), dvec3(10, 5, 0)));
    const LoadedScene ids = makeInstancedFile().read(members(attributes(R"("_ID":4)")));
    EXPECT_EQ(findDrawn(ids.world).size(), 3u);
}

TEST(GltfInstancing, InstancesMoveWithTheirNodeAndMorphLikeIt) {
    GltfFile file = makeInstancedFile();
    file.add(std::vector<float>{0, 1}, kFloat, "SCALAR");
    file.add(std::vector<float>{0, 0, 0, 100, 0, 0}, kFloat, "VEC3");
    file.add(std::vector<float>{0, 1}, kFloat, "SCALAR");
    const LoadedScene scene = file.read(members(
        kAll,
        R"("mesh":0,"weights":[0.5],"extras":{"vertexWaves":{"exponent":2}})",
        R"(,"animations":[{"channels":[{"sampler":0,"target":{"node":0,"path":"translation"}},
            {"sampler":1,"target":{"node":0,"path":"weights"}}],
            "samplers":[{"input":5,"output":6},{"input":5,"output":7}]}])"
    ));
    const scene::World& world = scene.world;
    const std::vector<ecs::Entity> drawn = findDrawn(world);
    ASSERT_EQ(drawn.size(), 2u);
    for (const ecs::Entity entity : drawn) {
        EXPECT_TRUE(scene::mayMove(world, entity));
        const auto& morph = world.registry.get<scene::MorphWeights>(entity);
        EXPECT_EQ(morph.weights, std::vector<float>{0.5f});
        EXPECT_EQ(morph.channels.size(), 1u);
        EXPECT_EQ(world.registry.get<scene::VertexWaves>(entity).exponent, 2.0);
    }
    EXPECT_EQ(dvec3(scene::worldFromEntity(world, drawn[0], 1.0)[3]), dvec3(101, 0, 0));
    std::vector<ecs::Entity> morphed;
    for (const auto& [entity, morph] : world.registry.view<const scene::MorphWeights>())
        morphed.push_back(entity);
    EXPECT_EQ(morphed, drawn) << "the node itself draws nothing that could be morphed";
}

TEST(GltfInstancing, ASkinnedNodeIsDrawnOnceAndRotationsWithoutABufferViewTurnNothing) {
    const std::string skin = R"(,"skins":[{"joints":[0]}])";
    const LoadedScene skinned =
        makeInstancedFile().read(members(kAll, R"("mesh":0,"skin":0)", skin));
    EXPECT_EQ(findDrawn(skinned.world).size(), 1u);
    EXPECT_TRUE(hasWarning(skinned, "EXT_mesh_gpu_instancing is ignored"));
    GltfFile file = makeInstancedFile();
    file.addAccessor(R"({"componentType":5126,"count":2,"type":"VEC4"})");
    const LoadedScene scene = file.read(members(attributes(R"("ROTATION":5)")));
    EXPECT_EQ(findDrawn(scene.world).size(), 2u);
    EXPECT_TRUE(hasWarning(scene, "ROTATION has no bufferView"));
}

TEST(GltfInstancing, DamagedInstancesAreRefusedAndMoreThanMemoryHolds) {
    const std::string at = "nodes[0].extensions.EXT_mesh_gpu_instancing.attributes";
    const auto load = [](const std::string& extension) {
        GltfFile file = makeInstancedFile();
        file.addAccessor(R"({"componentType":5126,"count":40000000,"type":"VEC3"})");
        return file.load(members(extension));
    };
    for (const char* empty : {"", R"("attributes":{})", R"("attributes":[1])"})
        expectRefused(load(empty), at + " is missing or empty");
    expectRefused(load(attributes(R"("TRANSLATION":"1")")), at + ".TRANSLATION is not a number");
    expectEachRefused(
        [&](const std::string& list) { return load(attributes(list)); },
        {{R"("TRANSLATION":1.5)", "not an index"},
         {R"("TRANSLATION":99)", "TRANSLATION is 99, but there are 6 accessors"},
         {R"("TRANSLATION":1,"_ID":4)", "has 3 instances, others have 2"},
         {R"("TRANSLATION":2)", "TRANSLATION: accessors[2].type"},
         {R"("_ID":5)", "4 GiB"}}
    );
    for (const float bad : {std::numeric_limits<float>::quiet_NaN(), 2e30f}) {
        const GltfFile file = makeInstancedFile({1, 0, 0, 0, bad, 0});
        expectRefused(file.load(members(kAll)), ".TRANSLATION holds");
    }
    const GltfFile file = makeInstancedFile({1, 0, 0, 0, 0, 0}, {0, 0, 0, 1, 0, 0, 0, 0});
    expectRefused(file.load(members(kAll)), "ROTATION: rotation 1 has no length");
}

core::Result<LoadedScene> loadExtras(const std::string& extras) {
    return loadMembers(
        R"("scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"name":"it","extras":)" + extras + "}]"
    );
}

/// Expects that extras with each member of that name are refused by a sentence that names it and
/// the part beside it.
void expectExtrasRefused(
    const std::string& name, std::initializer_list<std::pair<const char*, const char*>> members
) {
    for (const auto& [json, part] : members) {
        SCOPED_TRACE(json);
        const auto loaded = loadExtras("{\"" + name + "\":" + json + "}");
        expectRefused(loaded, "nodes[0].extras." + name);
        expectRefused(loaded, part);
    }
}

/// The only component of its type.
template <class Component> const Component* findOnly(const LoadedScene& loaded) {
    const Component* only = nullptr;
    for (auto [entity, component] : loaded.world.registry.view<Component>()) {
        EXPECT_EQ(only, nullptr) << "there are several";
        only = &component;
    }
    return only;
}

TEST(GltfMotionBlur, MotionBlurIsReadFromExtrasAndBadValuesAreRefusedByName) {
    const auto read = [](const char* members) {
        const LoadedScene scene =
            expectLoads(loadExtras(R"({"motionBlur":{)" + std::string(members) + "}}"));
        const auto* blur = findOnly<scene::MotionBlur>(scene);
        return blur ? *blur : scene::MotionBlur{-1.0};
    };
    EXPECT_EQ(read(R"("scale":0.5,"exclude":true)").scale, 0.5);
    EXPECT_TRUE(read(R"("scale":0.5,"exclude":true)").exclude);
    EXPECT_EQ(read(R"("scale":2)").scale, 2.0);
    EXPECT_FALSE(read(R"("scale":2)").exclude);
    EXPECT_EQ(read(R"("exclude":false)").scale, 1.0);
    // Other extras are ignored. tinygltf drops members that are null or empty.
    for (const char* extras :
         {"{}", "3", "[1]", R"("motionBlur")", R"({"other":{"scale":9}})", R"({"motionBlur":{}})"})
        EXPECT_FALSE(findOnly<scene::MotionBlur>(expectLoads(loadExtras(extras)))) << extras;
    expectExtrasRefused(
        "motionBlur",
        {{"1", ""},
         {R"({"scale":-0.1})", ".scale"},
         {R"({"scale":2.5})", ".scale"},
         {R"({"scale":1e31})", ".scale"},
         {R"({"scale":"1"})", ".scale"},
         {R"({"exclude":1})", ".exclude"},
         {R"({"exclude":"yes"})", ".exclude"}}
    );
}

TEST(GltfExtras, UnknownMembersAreWarnedOf) {
    const auto warnings = [](const std::string& extras) {
        return expectLoads(loadExtras(extras)).warnings;
    };
    EXPECT_EQ(
        warnings(R"({"motionBlur":{"excluded":true}})"),
        std::vector<std::string>{"nodes[0].extras.motionBlur has a member 'excluded': not used"}
    );
    const auto waves = warnings(R"({"vertexWaves":{"speed":1,"waves":[{"amplitude":2}]}})");
    ASSERT_EQ(waves.size(), 2u);
    EXPECT_NE(waves[0].find("'speed'"), std::string::npos);
    EXPECT_NE(waves[1].find("waves[0] has a member 'amplitude'"), std::string::npos);
}

core::Result<LoadedScene> loadLens(const std::string& extras) {
    return loadMembers(
        R"("scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"camera":0}],"cameras":[{"type":)"
        R"("perspective","perspective":{"yfov":0.7,"znear":0.1},"extras":)" +
        extras + "}]"
    );
}

const scene::CameraLens* findLens(const LoadedScene& loaded) {
    return loaded.world.registry.find<scene::CameraLens>(loaded.world.cameras.at(0));
}

TEST(GltfLens, TheLensIsReadFromTheCamerasExtras) {
    const LoadedScene all = expectLoads(
        loadLens(R"({"lens":{"fStop":2.8,"focusDistance":3,"sensorHeight":0.018,"blades":6,)"
                 R"("bladeRotation":0.5,"roundness":0.25,"squeeze":0.5,"blurScale":1.5}})")
    );
    ASSERT_TRUE(findLens(all));
    EXPECT_EQ(findLens(all)->fStop, 2.8);
    EXPECT_EQ(findLens(all)->focusDistance, 3.0);
    EXPECT_EQ(findLens(all)->sensorHeight, 0.018);
    EXPECT_EQ(findLens(all)->blades, 6u);
    EXPECT_EQ(findLens(all)->bladeRotation, 0.5);
    EXPECT_EQ(findLens(all)->roundness, 0.25);
    EXPECT_EQ(findLens(all)->squeeze, 0.5);
    EXPECT_EQ(findLens(all)->blurScale, 1.5);
    const LoadedScene some = expectLoads(loadLens(R"({"lens":{"fStop":2.8,"focus":3}})"));
    EXPECT_EQ(findLens(some)->sensorHeight, scene::CameraLens{}.sensorHeight);
    ASSERT_EQ(some.warnings.size(), 1u);
    EXPECT_EQ(some.warnings[0], "cameras[0].extras.lens has a member 'focus': not used");
    EXPECT_FALSE(findLens(expectLoads(loadLens("{}"))));
}

TEST(GltfExtras, OwnNamesInOtherCaseOrOfAnotherPartAreWarnedOf) {
    const auto warnings = [](const std::string& camera, const std::string& node) {
        return readMembers(
                   R"("scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"camera":0,"extras":)" + node +
                   R"(}],"cameras":[{"type":"perspective","perspective":)"
                   R"({"yfov":0.7,"znear":0.1},"extras":)" +
                   camera + "}]"
        )
            .warnings;
    };
    const std::string lens = R"({"lens":{"fStop":2}})";
    EXPECT_EQ(
        warnings("{}", lens),
        std::vector<std::string>{
            "nodes[0].extras.lens is not used: it is 'lens' in the extras of a camera"}
    );
    EXPECT_EQ(
        warnings(R"({"Lens":{"fStop":2}})", "{}"),
        std::vector<std::string>{
            "cameras[0].extras.Lens is not used: it is 'lens' in the extras of a camera"}
    );
    EXPECT_EQ(
        warnings("{}", R"({"motionblur":{"scale":0}})"),
        std::vector<std::string>{
            "nodes[0].extras.motionblur is not used: it is 'motionBlur' in the extras of a node"}
    );
    // Other programs' own: numbers and names.
    EXPECT_TRUE(warnings(lens, R"({"lens":50,"sharpness":{"a":1}})").empty());
}

core::Result<LoadedScene> loadFocus(const std::string& lens) {
    return loadMembers(
        R"("scene":0,"scenes":[{"nodes":[0,1,2,3]}],"nodes":[{"camera":0},{"name":"ball"},)"
        R"({"name":"twin"},{"name":"twin"},{"name":"elsewhere"}],"cameras":[{"type":)"
        R"("perspective","perspective":{"yfov":0.7,"znear":0.1},"extras":{"lens":{)" +
        lens + "}}}]"
    );
}

TEST(GltfLens, ANodeMayBeFocusedOn) {
    const LoadedScene loaded =
        expectLoads(loadFocus(R"("fStop":2,"focusNode":"ball","focusHalfLife":0.5)"));
    EXPECT_TRUE(loaded.warnings.empty());
    const auto* focus = loaded.world.registry.find<scene::AutoFocus>(loaded.world.cameras.at(0));
    ASSERT_TRUE(focus);
    EXPECT_EQ(focus->target, findNamed(loaded.world, "ball"));
    EXPECT_EQ(focus->halfLife, 0.5);
    const LoadedScene without = expectLoads(loadFocus(R"("fStop":2)"));
    EXPECT_FALSE(without.world.registry.has<scene::AutoFocus>(without.world.cameras.at(0)));
    const std::string at = "cameras[0].extras.lens.";
    expectRefused(loadFocus(R"("focusNode":"nobody")"), at + "focusNode 'nobody'");
    expectRefused(loadFocus(R"("focusNode":"twin")"), at + "focusNode 'twin'");
    expectRefused(loadFocus(R"("focusNode":"elsewhere")"), at + "focusNode 'elsewhere'");
    expectRefused(loadFocus(R"("focusNode":1)"), at + "focusNode");
    expectRefused(loadFocus(R"("focusHalfLife":1)"), at + "focusHalfLife");
    for (const char* bad : {"-1", "2000", "\"1\""})
        expectRefused(
            loadFocus(R"("focusNode":"ball","focusHalfLife":)" + std::string(bad)),
            at + "focusHalfLife"
        );
}

TEST(GltfLens, AnOrthographicCameraHasNoneAndAWarningStatesIt) {
    const auto load = [](const std::string& lens) {
        return loadMembers(
            R"("scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"name":"it","camera":0}],"cameras":)"
            R"([{"type":"orthographic","orthographic":{"xmag":2,"ymag":2,"znear":0.1,"zfar":9},)"
            R"("extras":{"lens":{)" +
            lens + "}}}]"
        );
    };
    const LoadedScene loaded = expectLoads(load(R"("fStop":2,"focusNode":"it")"));
    EXPECT_FALSE(findLens(loaded));
    EXPECT_FALSE(loaded.world.registry.has<scene::AutoFocus>(loaded.world.cameras.at(0)));
    ASSERT_EQ(loaded.warnings.size(), 1u);
    EXPECT_EQ(
        loaded.warnings[0],
        "cameras[0].extras.lens: an orthographic camera has no lens, it is not used"
    );
    expectRefused(load(R"("fStop":-1)"), "cameras[0].extras.lens.fStop");
}

TEST(GltfLens, BadValuesAreRefusedByName) {
    expectRefused(loadLens(R"({"lens":1})"), "cameras[0].extras.lens");
    for (const std::string& member : test::rowsOf(
             "fStop:-1|fStop:0.001|fStop:\"2\"|focusDistance:0|focusDistance:-3|sensorHeight:0|"
             "blades:2|blades:2.5|bladeRotation:99|roundness:2|squeeze:0|blurScale:3"
         )) {
        const std::string name = member.substr(0, member.find(':'));
        const std::string value = member.substr(member.find(':'));
        expectRefused(
            loadLens(R"({"lens":{")" + name + "\"" + value + "}}"), "cameras[0].extras.lens." + name
        );
    }
}

TEST(GltfVertexWaves, VertexWavesAreReadFromExtras) {
    const LoadedScene loaded = expectLoads(loadExtras(
        R"({"vertexWaves":{"lean":[0.1,0,0],"space":"world","share":"height","axis":[0,0,1],)"
        R"("heldAt":0.5,"freeAt":2,"exponent":3,"waves":[{"displacement":[1,2,3],)"
        R"("waveVector":[4,5,6],"hertz":7,"phase":8},{"hertz":1}]}})"
    ));
    EXPECT_TRUE(loaded.warnings.empty());
    const auto* waves = findOnly<scene::VertexWaves>(loaded);
    ASSERT_TRUE(waves);
    EXPECT_EQ(waves->lean, dvec3(0.1, 0, 0));
    EXPECT_TRUE(waves->inWorld);
    EXPECT_EQ(waves->share, scene::WaveShare::Height);
    EXPECT_EQ(waves->axis, dvec3(0, 0, 1));
    EXPECT_EQ(waves->heldAt, 0.5);
    EXPECT_EQ(waves->freeAt, 2.0);
    EXPECT_EQ(waves->exponent, 3.0);
    ASSERT_EQ(waves->waves.size(), 2u);
    EXPECT_EQ(waves->waves[0].displacement, dvec3(1, 2, 3));
    EXPECT_EQ(waves->waves[0].waveVector, dvec3(4, 5, 6));
    EXPECT_EQ(waves->waves[0].hertz, 7.0);
    EXPECT_EQ(waves->waves[0].phase, 8.0);
    EXPECT_EQ(waves->waves[1].displacement, dvec3(0.0));
}

TEST(GltfVertexWaves, BadValuesAreRefusedByName) {
    std::string many = R"({"waves":[{"hertz":1})";
    for (int i = 0; i < 16; ++i)
        many += R"(,{"hertz":1})";
    many += "]}";
    expectExtrasRefused(
        "vertexWaves",
        {{many.c_str(), "17 waves"},
         {R"(3)", ""},
         {R"({"waves":{"a":1}})", ".waves"},
         {R"({"waves":[1]})", ".waves[0]"},
         {R"({"waves":[{"hertz":-1}]})", "waves[0].hertz"},
         {R"({"waves":[{"displacement":[1,2]}]})", ".waves[0].displacement"},
         {R"({"space":"view"})", ".space"},
         {R"({"share":"weight"})", ".share"},
         {R"({"share":"color","channel":4})", "channel"},
         {R"({"share":"height","axis":[0,0,0]})", "axis"},
         {R"({"exponent":0})", "exponent"}}
    );
}

} // namespace
} // namespace shutter::gltf
