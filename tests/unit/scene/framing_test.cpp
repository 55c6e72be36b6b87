// SPDX-License-Identifier: MIT
#include "engine/math/transform.h"
#include "engine/scene/camera.h"
#include "engine/scene/motion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace shutter::scene {
namespace {

using math::dmat4;
using math::dvec3;
using math::dvec4;

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

TEST(ComputeWorldBounds, AreEmptyForAnEmptySceneAndForMeshesWithoutPoints) {
    World world;
    EXPECT_TRUE(computeWorldBounds(world, 0.0).isEmpty());
    world.assets.meshes.emplace_back();
    world.registry.add(world.registry.create(), MeshInstance{0});
    world.registry.add(world.registry.create(), MeshInstance{kNone});
    EXPECT_TRUE(computeWorldBounds(world, 0.0).isEmpty());
}

TEST(ComputeWorldBounds, HoldEveryDrawnEntityWhereItIsAtThatTime) {
    World world;
    addBox(world, dvec3(-1.0), dvec3(0.0));
    const ecs::Entity mover = addBox(world, dvec3(0.0), dvec3(1.0));
    world.registry.add(mover, LinearVelocity{{10.0, 0.0, 0.0}});
    const math::Bounds bounds = computeWorldBounds(world, 2.0);
    EXPECT_EQ(bounds.min, dvec3(-1.0));
    EXPECT_EQ(bounds.max, dvec3(21.0, 1.0, 1.0));
}

TEST(ComputeWorldBounds, LeaveOutWhatIsNowhere) {
    World world;
    addBox(world, dvec3(-1.0), dvec3(1.0));
    const ecs::Entity lost = addBox(world, dvec3(-1.0), dvec3(1.0));
    math::Transform nowhere;
    nowhere.translation.x = 100.0; // the finite axes must not count either
    nowhere.translation.y = std::numeric_limits<double>::quiet_NaN();
    world.registry.add(lost, LocalTransform{nowhere});
    EXPECT_EQ(computeWorldBounds(world, 0.0).max, dvec3(1.0));
    nowhere.translation.y = std::numeric_limits<double>::infinity();
    world.registry.add(lost, LocalTransform{nowhere});
    EXPECT_EQ(computeWorldBounds(world, 0.0).max, dvec3(1.0));
}

TEST(ComputeWorldBounds, HoldASkinnedMeshWhereItsJointsPutIt) {
    World world;
    const ecs::Entity entity = addBox(world, dvec3(-1.0), dvec3(1.0));
    Mesh& mesh = world.assets.meshes[0];
    mesh.primitives.emplace_back();
    mesh.primitives[0].positions = {math::vec3(-1.0f), math::vec3(1.0f)};
    mesh.primitives[0].influenceCount = 4;
    mesh.primitives[0].joints.assign(8, 0);
    mesh.primitives[0].weights = {1, 0, 0, 0, 1, 0, 0, 0};
    world.assets.skins.push_back({"", {dmat4(1.0)}});
    const ecs::Entity joint = world.registry.create();
    world.registry.add(joint, LinearVelocity{{10.0, 0.0, 0.0}});
    world.registry.add(entity, Skinned{0, {joint}});
    world.registry.add(entity, LocalTransform{{dvec3(0.0, 500.0, 0.0)}});
    const math::Bounds bounds = computeWorldBounds(world, 2.0);
    EXPECT_NEAR(bounds.min.x, 19.0, 1e-4);
    EXPECT_NEAR(bounds.max.x, 21.0, 1e-4);
    EXPECT_NEAR(bounds.max.y, 1.0, 1e-4) << "its own transform has no meaning";
}

TEST(ComputeWorldBounds, HoldAMorphedMeshAtItsWeights) {
    World world;
    const ecs::Entity entity = addBox(world, dvec3(0.0), dvec3(1.0));
    Mesh& mesh = world.assets.meshes[0];
    mesh.primitives.emplace_back();
    mesh.primitives[0].positions = {math::vec3(0.0f), math::vec3(1.0f)};
    mesh.primitives[0].morphTargets = {{{math::vec3(0.0f), math::vec3(0.0f, 4.0f, 0.0f)}, {}, {}}};
    world.registry.add(entity, MorphWeights{{0.5f}, {}});
    EXPECT_NEAR(computeWorldBounds(world, 0.0).max.y, 3.0, 1e-4);
}

TEST(ComputeWorldBoundsDeathTest, AMeshIndexPastTheEndIsAProgrammersMistake) {
    World world;
    world.registry.add(world.registry.create(), MeshInstance{3});
    EXPECT_DEATH((void)computeWorldBounds(world, 0.0), "no mesh 3");
}

TEST(AddFramingCamera, SeesTheWholeSceneAndFillsThePictureAtAnySizeAndAspect) {
    struct Case {
        dvec3 min;
        dvec3 max;
        double leastReach; // a line along the view looks short
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

TEST(AddFramingCamera, LooksFromTheFrontAndALittleAbove) {
    World world;
    addBox(world, dvec3(-1.0), dvec3(1.0));
    const dmat4 pose = worldFromEntity(world, addFramingCamera(world, 1.0, 0.0), 0.0);
    EXPECT_NEAR(pose[3].x, 0.0, 1e-12);
    EXPECT_GT(pose[3].y, 0.0);
    EXPECT_GT(pose[3].z, 1.0);
    EXPECT_LT(pose[3].y, pose[3].z);
    const dvec3 forward = -dvec3(pose[2]);
    EXPECT_NEAR(glm::dot(glm::normalize(dvec3(pose[3])), forward), -1.0, 1e-12); // at the centre
}

TEST(AddFramingCamera, IsRegisteredLastWithAFieldOfViewOf45Degrees) {
    World world;
    world.cameras.push_back(world.registry.create());
    const ecs::Entity entity = addFramingCamera(world, 1.0, 0.0);
    ASSERT_EQ(world.cameras.size(), 2u);
    EXPECT_EQ(world.cameras.back(), entity);
    const Camera& camera = world.registry.get<Camera>(entity);
    EXPECT_EQ(camera.kind, CameraKind::Perspective);
    EXPECT_DOUBLE_EQ(camera.yFov, std::numbers::pi / 4.0);
    EXPECT_GT(camera.near, 0.0);
}

TEST(AddFramingCamera, FramesTheOriginOfAnEmptySceneAndThePlaceOfAPoint) {
    World empty;
    const dmat4 atOrigin = worldFromEntity(empty, addFramingCamera(empty, 1.0, 0.0), 0.0);
    EXPECT_TRUE(math::isFinite(atOrigin));
    const double distance = glm::length(dvec3(atOrigin[3]));
    EXPECT_GT(distance, 0.5);
    EXPECT_LT(distance, 10.0);

    World point;
    addBox(point, dvec3(50.0, 60.0, 70.0), dvec3(50.0, 60.0, 70.0));
    const dmat4 atPoint = worldFromEntity(point, addFramingCamera(point, 1.0, 0.0), 0.0);
    const dvec3 offset = dvec3(atPoint[3]) - dvec3(50.0, 60.0, 70.0);
    EXPECT_NEAR(glm::length(offset - dvec3(atOrigin[3])), 0.0, 1e-9);
}

TEST(AddFramingCamera, FramesTheSceneAsItIsAtThatTime) {
    World world;
    const ecs::Entity mover = addBox(world, dvec3(-1.0), dvec3(1.0));
    world.registry.add(mover, LinearVelocity{{100.0, 0.0, 0.0}});
    const dmat4 pose = worldFromEntity(world, addFramingCamera(world, 1.0, 3.0), 3.0);
    EXPECT_NEAR(pose[3].x, 300.0, 1e-9);
}

TEST(AddFramingCameraDeathTest, AnAspectThatIsNoShapeIsAProgrammersMistake) {
    World world;
    EXPECT_DEATH((void)addFramingCamera(world, 0.0, 0.0), "aspect is 0");
    EXPECT_DEATH(
        (void)addFramingCamera(world, std::numeric_limits<double>::quiet_NaN(), 0.0),
        "aspect is nan"
    );
}

} // namespace
} // namespace shutter::scene
