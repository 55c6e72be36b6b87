// SPDX-License-Identifier: MIT
// Cameras: cuts, the framing of a scene, and what a ray through the middle of the picture meets.
#include "engine/math/transform.h"
#include "engine/scene/camera.h"
#include "engine/scene/history.h"
#include "engine/scene/motion.h"
#include "engine/scene/ray_cast.h"
#include "tests/kit/scene_builder.h"
#include "tests/unit/scene/near.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace shutter::scene {
namespace {

using math::dmat4;
using math::dvec3;
using math::dvec4;

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr CutDetection kDetection{true, 10.0, 0.5};

dmat4 pose(double degrees, const dvec3& position) {
    math::Transform transform;
    transform.translation = position;
    transform.rotation = glm::angleAxis(degrees * kDegree, dvec3(0.0, 1.0, 0.0));
    return math::computeMatrix(transform);
}

bool finds(const PoseAt& poseAt) {
    return findsCameraCut(poseAt, 100.0, 100.02, kDetection);
}

TEST(CameraCut, FastMotionAndJumpsBelowTheThresholdsAreNoCuts) {
    for (const double speed : {30.0, 180.0, 2000.0, 1e5, 1e7}) { // degrees or metres a second
        EXPECT_FALSE(finds([&](double t) { return pose(0.0, {speed * (t - 100.0), 0, 0}); }));
        if (speed <= 1e5) {
            EXPECT_FALSE(finds([&](double t) { return pose(speed * (t - 100.0), dvec3(0.0)); }));
        }
    }
    EXPECT_FALSE(finds([&](double t) { return pose(t < 100.01 ? 0.0 : 9.0, dvec3(0.0)); }));
    EXPECT_FALSE(finds([&](double t) { return pose(0.0, {t < 100.01 ? 0.0 : 0.45, 0, 0}); }));
}

TEST(CameraCut, AJumpAtAnyTimeIsACut) {
    for (const double at : {100.0000001, 100.0007, 100.01, 100.01999}) {
        EXPECT_TRUE(finds([&](double t) { return pose(t < at ? 0.0 : 15.0, dvec3(0.0)); })) << at;
        EXPECT_TRUE(finds([&](double t) { return pose(0.0, dvec3(t < at ? 0.0 : 0.7)); })) << at;
    }
    EXPECT_TRUE(finds([&](double t) {
        return pose(4000.0 * (t - 100.0) + (t < 100.0123 ? 0.0 : 25.0), {300.0 * t, 0, 0});
    })) << "within a fast pan";
    // An excursion over three whole intervals: two jumps, each found by itself.
    EXPECT_TRUE(finds([&](double t) {
        return pose(t > 100.005 && t < 100.009 ? 90.0 : 0.0, dvec3(0.0));
    }));
    // Where two neighbouring times are 1e-7 s apart, the halving ends early.
    const auto late = [](double t) { return pose(t < 1e9 + 0.5 ? 0.0 : 90.0, dvec3(0.0)); };
    EXPECT_TRUE(findsCameraCut(late, 1e9, 1e9 + 1, kDetection));
}

TEST(CameraCut, NoCutIsFoundWithDetectionOffInNoTimeOrOfACameraThatIsNowhereForAWhile) {
    const auto jumps = [](double t) { return pose(t < 100.01 ? 0.0 : 90.0, dvec3(0.0)); };
    EXPECT_FALSE(findsCameraCut(jumps, 100.0, 100.02, {false, 10.0, 0.5}));
    EXPECT_FALSE(findsCameraCut(jumps, 100.01, 100.01, kDetection));
    EXPECT_FALSE(findsCameraCut(jumps, 100.02, 100.0, kDetection));
    EXPECT_FALSE(finds([&](double t) {
        return math::removeScale(pose(t < 100.01 ? 0.0 : kNan, dvec3(t < 100.01 ? 0.0 : kNan)));
    }));
}

ecs::Entity addBox(World& world, const dvec3& min, const dvec3& max) {
    Mesh mesh;
    mesh.bounds.add(min);
    mesh.bounds.add(max);
    world.assets.meshes.push_back(mesh);
    const ecs::Entity entity = world.registry.create();
    const auto index = static_cast<AssetIndex>(world.assets.meshes.size() - 1);
    world.registry.add(entity, MeshInstance{index});
    return entity;
}

/// Largest |x| or |y| in clip space of the bounds' corners; checks that all lie beyond the near
/// plane. 1 is the border of the picture.
double computeReach(World& world, ecs::Entity cameraEntity, double aspect, double seconds) {
    const Camera& camera = world.registry.get<Camera>(cameraEntity);
    const dmat4 clipFromView = math::clipFromViewPerspective(camera.yFov, aspect, camera.near);
    const dmat4 clipFromWorld =
        clipFromView * glm::inverse(worldFromEntity(world, cameraEntity, seconds));
    const math::Bounds bounds = computeWorldBounds(world, seconds);
    double reach = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
        const dvec3 point(
            corner & 1 ? bounds.max.x : bounds.min.x,
            corner & 2 ? bounds.max.y : bounds.min.y,
            corner & 4 ? bounds.max.z : bounds.min.z
        );
        const dvec4 clip = clipFromWorld * dvec4(point, 1.0);
        EXPECT_GT(clip.w, camera.near);
        reach = std::max({reach, std::abs(clip.x / clip.w), std::abs(clip.y / clip.w)});
    }
    return reach;
}

TEST(ComputeWorldBounds, BoundsContainEveryFiniteDrawnEntityAtThatTime) {
    World world;
    EXPECT_TRUE(computeWorldBounds(world, 0.0).isEmpty());
    world.assets.meshes.emplace_back();
    world.registry.add(world.registry.create(), MeshInstance{0});
    world.registry.add(world.registry.create(), MeshInstance{kNone});
    EXPECT_TRUE(computeWorldBounds(world, 0.0).isEmpty());
    addBox(world, dvec3(-1.0), dvec3(0.0));
    const ecs::Entity mover = addBox(world, dvec3(0.0), dvec3(1.0));
    world.registry.add(mover, LinearVelocity{{10.0, 0.0, 0.0}});
    const ecs::Entity lost = addBox(world, dvec3(-1.0), dvec3(1.0));
    for (const double bad : {kNan, kInfinity}) {
        // The finite axes must not count either.
        world.registry.add(lost, LocalTransform{{{100.0, bad, 0.0}}});
        const math::Bounds bounds = computeWorldBounds(world, 2.0);
        EXPECT_EQ(bounds.min, dvec3(-1.0));
        EXPECT_EQ(bounds.max, dvec3(21.0, 1.0, 1.0));
    }
    world.registry.add(lost, MeshInstance{4});
    EXPECT_DEATH((void)computeWorldBounds(world, 0.0), "no mesh 4");
}

TEST(ComputeWorldBounds, BoundsContainASkinnedMeshInItsPoseAndAMorphedOneAtItsWeights) {
    World world;
    const ecs::Entity entity = addBox(world, dvec3(0.0), dvec3(1.0));
    Primitive& primitive = world.assets.meshes[0].primitives.emplace_back();
    primitive.positions = {math::vec3(0.0f), math::vec3(1.0f)};
    primitive.morphTargets = {{{math::vec3(0.0f), math::vec3(0.0f, 4.0f, 0.0f)}, {}, {}}};
    world.registry.add(entity, MorphWeights{{0.5f}, {}});
    EXPECT_NEAR(computeWorldBounds(world, 0.0).max.y, 3.0, 1e-4);
    primitive.influenceCount = 4;
    primitive.joints.assign(8, 0);
    primitive.weights = {1, 0, 0, 0, 1, 0, 0, 0};
    world.assets.skins.push_back({"", {dmat4(1.0)}});
    const ecs::Entity joint = world.registry.create();
    world.registry.add(joint, LinearVelocity{{10.0, 0.0, 0.0}});
    world.registry.add(entity, Skinned{0, {joint}});
    world.registry.add(entity, LocalTransform{{dvec3(0.0, 500.0, 0.0)}});
    const math::Bounds bounds = computeWorldBounds(world, 2.0);
    EXPECT_NEAR(bounds.min.x, 20.0, 1e-4);
    EXPECT_NEAR(bounds.max.x, 21.0, 1e-4);
    EXPECT_NEAR(bounds.max.y, 3.0, 1e-4) << "its own transform has no meaning";
}

TEST(AddFramingCamera, TheCameraFramesTheWholeSceneAtAnySizeAndAspect) {
    struct Case {
        dvec3 min;
        dvec3 max;
        double leastReach; // a line along the view is foreshortened
    };

    const Case cases[] = {
        {{-1, -1, -1}, {1, 1, 1}, 0.5},
        {{-500, 0, -500}, {500, 20, 500}, 0.5},
        {{1e5, 2e5, 3e5}, {1e5 + 1, 2e5 + 3, 3e5 + 2}, 0.5},
        {{0, 0, -100}, {0, 0, 100}, 0.0},
        {{0, 0, 0}, {0, 50, 0}, 0.5},
        {{-1e-4, -1e-4, -1e-4}, {1e-4, 1e-4, 1e-4}, 0.5},
    };
    for (const Case& scene : cases) {
        for (const double aspect : {0.25, 1.0, 16.0 / 9.0, 4.0}) {
            World world;
            addBox(world, scene.min, scene.max);
            const ecs::Entity camera = addFramingCamera(world, aspect, 0.0);
            const double reach = computeReach(world, camera, aspect, 0.0);
            EXPECT_LT(reach, 0.98) << scene.min.x << " aspect " << aspect;
            EXPECT_GE(reach, scene.leastReach) << scene.min.x << " aspect " << aspect;
        }
    }
}

TEST(AddFramingCamera, TheCameraIsInFrontALittleAboveAndTheLastWithAFieldOfViewOf45Degrees) {
    World world;
    world.cameras.push_back(world.registry.create());
    const ecs::Entity mover = addBox(world, dvec3(-1.0), dvec3(1.0));
    world.registry.add(mover, LinearVelocity{{100.0, 0.0, 0.0}});
    const ecs::Entity entity = addFramingCamera(world, 1.0, 3.0);
    const dmat4 pose = worldFromEntity(world, entity, 3.0);
    EXPECT_NEAR(pose[3].x, 300.0, 1e-9) << "of the scene at that time";
    EXPECT_GT(pose[3].y, 0.0);
    EXPECT_GT(pose[3].z, 1.0);
    EXPECT_LT(pose[3].y, pose[3].z);
    const dvec3 away = glm::normalize(dvec3(pose[3]) - dvec3(300.0, 0.0, 0.0));
    EXPECT_NEAR(glm::dot(away, dvec3(pose[2])), 1.0, 1e-12) << "at the centre";
    ASSERT_EQ(world.cameras.size(), 2u);
    EXPECT_EQ(world.cameras.back(), entity);
    const Camera& camera = world.registry.get<Camera>(entity);
    EXPECT_EQ(camera.kind, CameraKind::Perspective);
    EXPECT_DOUBLE_EQ(camera.yFov, std::numbers::pi / 4.0);
    EXPECT_GT(camera.near, 0.0);
}

TEST(AddFramingCamera, TheOriginOfAnEmptySceneAndThePlaceOfAPointAreFramed) {
    World empty;
    const dmat4 atOrigin = worldFromEntity(empty, addFramingCamera(empty, 1.0, 0.0), 0.0);
    EXPECT_TRUE(math::isFinite(atOrigin));
    EXPECT_GT(glm::length(dvec3(atOrigin[3])), 0.5);
    EXPECT_LT(glm::length(dvec3(atOrigin[3])), 10.0);
    const dvec3 place(50.0, 60.0, 70.0);
    World point;
    addBox(point, place, place);
    const dmat4 atPoint = worldFromEntity(point, addFramingCamera(point, 1.0, 0.0), 0.0);
    expectNear(dvec3(atPoint[3]) - place, dvec3(atOrigin[3]));
    EXPECT_DEATH((void)addFramingCamera(point, 0.0, 0.0), "aspect is 0");
    EXPECT_DEATH((void)addFramingCamera(point, kNan, 0.0), "aspect is nan");
}

using test::SceneBuilder;

std::optional<double> measure(const SceneBuilder& scene, double seconds = 0.0) {
    return findMiddleDistance(scene.world, scene.camera, seconds);
}

TEST(RayCast, TheNearestSurfaceIsMetAndTheSkyIsNothing) {
    SceneBuilder scene;
    scene.setPerspective(0.9);
    EXPECT_FALSE(measure(scene));
    const AssetIndex grey = scene.addColor({0.5f, 0.5f, 0.5f});
    scene.add(test::makeQuad(4, 4, grey), {.position = {0, 0, -9}});
    const ecs::Entity box = scene.add(test::makeBox({1, 1, 1}, grey), {.position = {0.2, 0.1, -5}});
    EXPECT_NEAR(measure(scene).value(), 4.5, 1e-6);
    EXPECT_EQ(castRay(scene.world, {{0, 0, 0}, {0, 0, -1}}, 0.0).value().entity, box);
    EXPECT_NEAR(castRay(scene.world, {{0, 0, 0}, {0, 0, -1}, 4.6}, 0.0)->distance, 9.0, 1e-6)
        << "from inside, a box is not seen";
    hide(scene.world, box);
    EXPECT_NEAR(measure(scene).value(), 9.0, 1e-6);
    scene.moveCamera({.position = {0, 3, 0}});
    EXPECT_FALSE(measure(scene));
}

TEST(RayCast, BacksAreSeenOfTwoSidedMaterialsAndThingsBehindPanes) {
    SceneBuilder scene;
    scene.setPerspective(0.9);
    const math::dquat turned = glm::angleAxis(std::acos(-1.0), math::dvec3(0, 1, 0));
    Material pane;
    pane.alphaMode = AlphaMode::Blend;
    scene.add(test::makeQuad(2, 2, scene.addMaterial(pane)), {.position = {0, 0, -1}});
    const AssetIndex one = scene.addColor({1, 1, 1});
    scene.add(test::makeQuad(2, 2, one), {.position = {0, 0, -2}, .rotation = turned});
    EXPECT_FALSE(measure(scene));
    Material both;
    both.doubleSided = true;
    scene.add(
        test::makeQuad(2, 2, scene.addMaterial(both)), {.position = {0, 0, -3}, .rotation = turned}
    );
    EXPECT_NEAR(measure(scene).value(), 3.0, 1e-6);
    // A mirror turns the winding, not the side.
    scene.add(test::makeQuad(2, 2, one), {.position = {0, 0, -2.5}, .scale = {-1, 1, 1}});
    EXPECT_NEAR(measure(scene).value(), 2.5, 1e-6);
}

TEST(RayCast, ThingsAreWhereTheyAreThen) {
    SceneBuilder scene;
    scene.setPerspective(0.9);
    const AssetIndex grey = scene.addColor({0.5f, 0.5f, 0.5f});
    const ecs::Entity quad =
        scene.add(test::makeQuad(1, 1, grey), {.position = {0, 0, -2}, .velocity = {0, 0, -1}});
    EXPECT_NEAR(measure(scene, 3.0).value(), 5.0, 1e-6);
    VertexWaves waves;
    waves.lean = {0, 0, 0.25};
    waves.waves.push_back({.displacement = {0, 0, 0.5}, .hertz = 1.0});
    scene.world.registry.add(quad, waves);
    EXPECT_NEAR(measure(scene, 1.0).value(), 2.75, 1e-6);
    EXPECT_NEAR(measure(scene, 1.25).value(), 2.5, 1e-6);
    // Nowhere, and flat.
    const AssetIndex mesh = scene.world.registry.get<MeshInstance>(quad).mesh;
    scene.add(mesh, math::dmat4(0.0));
    scene.add(mesh, math::dmat4(std::nan("")));
    EXPECT_NEAR(measure(scene, 1.0).value(), 2.75, 1e-6);
}

} // namespace
} // namespace shutter::scene
