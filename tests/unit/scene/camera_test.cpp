// SPDX-License-Identifier: MIT
// Cameras: cuts, the framing of a scene, and lenses that zoom.
#include "engine/math/transform.h"
#include "engine/scene/camera.h"
#include "engine/scene/exposure_motion.h"
#include "engine/scene/motion.h"
#include "engine/scene/path.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

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
}

TEST(CameraCut, AJumpWithinAFastPanIsACut) {
    EXPECT_TRUE(finds([&](double t) {
        return pose(4000.0 * (t - 100.0) + (t < 100.0123 ? 0.0 : 25.0), {300.0 * t, 0, 0});
    }));
}

TEST(CameraCut, AnExcursionWithinASixteenthIsDetectedAtStepsOnly) {
    // Three whole intervals elsewhere: two jumps, each found by itself.
    EXPECT_TRUE(finds([&](double t) {
        return pose(t > 100.005 && t < 100.009 ? 90.0 : 0.0, dvec3(0.0));
    }));
}

TEST(CameraCut, NoCutIsFoundWithDetectionOffOrNoTime) {
    const auto jumps = [](double t) { return pose(t < 100.01 ? 0.0 : 90.0, dvec3(0.0)); };
    EXPECT_FALSE(findsCameraCut(jumps, 100.0, 100.02, {false, 10.0, 0.5}));
    EXPECT_FALSE(findsCameraCut(jumps, 100.01, 100.01, kDetection));
    EXPECT_FALSE(findsCameraCut(jumps, 100.02, 100.0, kDetection));
}

TEST(CameraCut, ACameraThatIsNowhereForAWhileIsNotCut) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(finds([&](double t) {
        return math::removeScale(pose(t < 100.01 ? 0.0 : nan, dvec3(t < 100.01 ? 0.0 : nan)));
    }));
}

TEST(CameraCut, AJumpFarFromTimeZeroIsACut) {
    // Where two neighbouring times are 1e-7 s apart, the halving ends early.
    EXPECT_TRUE(findsCameraCut(
        [](double t) { return pose(t < 1e9 + 0.5 ? 0.0 : 90.0, dvec3(0.0)); },
        1e9,
        1e9 + 1,
        kDetection
    ));
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

TEST(ComputeWorldBounds, BoundsOfAnEmptySceneOrMeshesWithoutPointsAreEmpty) {
    World world;
    EXPECT_TRUE(computeWorldBounds(world, 0.0).isEmpty());
    world.assets.meshes.emplace_back();
    world.registry.add(world.registry.create(), MeshInstance{0});
    world.registry.add(world.registry.create(), MeshInstance{kNone});
    EXPECT_TRUE(computeWorldBounds(world, 0.0).isEmpty());
}

TEST(ComputeWorldBounds, BoundsContainEveryDrawnEntityAtThatTime) {
    World world;
    addBox(world, dvec3(-1.0), dvec3(0.0));
    const ecs::Entity mover = addBox(world, dvec3(0.0), dvec3(1.0));
    world.registry.add(mover, LinearVelocity{{10.0, 0.0, 0.0}});
    const math::Bounds bounds = computeWorldBounds(world, 2.0);
    EXPECT_EQ(bounds.min, dvec3(-1.0));
    EXPECT_EQ(bounds.max, dvec3(21.0, 1.0, 1.0));
}

TEST(ComputeWorldBounds, BoundsOmitNonFiniteEntities) {
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

TEST(ComputeWorldBounds, BoundsContainASkinnedMeshInItsPose) {
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

TEST(ComputeWorldBounds, BoundsContainAMorphedMeshAtItsWeights) {
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

TEST(AddFramingCamera, TheCameraIsInFrontAndALittleAbove) {
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

TEST(AddFramingCamera, TheFramingCameraIsTheLastWithAFieldOfViewOf45Degrees) {
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

TEST(AddFramingCamera, TheOriginOfAnEmptySceneAndThePlaceOfAPointAreFramed) {
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

TEST(AddFramingCamera, TheSceneIsFramedAtThatTime) {
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

double focal(double yFov) {
    return 1.0 / std::tan(yFov / 2.0);
}

class Lens : public testing::Test {
  protected:
    Lens() : mCamera(mWorld.registry.create()) {
        mWorld.registry.add(mCamera, Camera{.yFov = 0.7});
    }

    void zoom(
        std::vector<LensKey> keys,
        PathInterpolation interpolation = PathInterpolation::CatmullRom,
        PathEase ease = PathEase::None
    ) {
        const LensMotion lens{std::move(keys), interpolation, ease};
        ASSERT_TRUE(validateLens(lens).ok());
        mWorld.registry.add(mCamera, lens);
    }

    [[nodiscard]] double at(double seconds) const { return yFovAt(mWorld, mCamera, seconds); }

    World mWorld;
    ecs::Entity mCamera;
};

TEST_F(Lens, ALensPassesItsKeysAndStaysAtTheEnds) {
    for (const auto interpolation : {PathInterpolation::Linear, PathInterpolation::CatmullRom}) {
        zoom({{0.0, 0.9}, {1.0, 0.4}, {3.0, 1.2}}, interpolation);
        EXPECT_TRUE(mayZoom(mWorld, mCamera));
        EXPECT_EQ(at(-1.0), 0.9);
        EXPECT_EQ(at(0.0), 0.9);
        EXPECT_NEAR(at(1.0), 0.4, 1e-15);
        EXPECT_EQ(at(3.0), 1.2);
        EXPECT_EQ(at(9.0), 1.2);
    }
}

TEST_F(Lens, TwoEqualKeysHoldStillToTheBit) {
    for (const auto interpolation : {PathInterpolation::Linear, PathInterpolation::CatmullRom}) {
        zoom({{0.0, 0.9}, {1.0, 0.4}, {3.0, 0.4}, {4.0, 1.2}}, interpolation);
        for (double t = 1.0; t <= 3.0; t += 0.125)
            EXPECT_EQ(at(t), at(1.0)) << t;
        EXPECT_NE(at(0.9), at(1.0));
    }
}

TEST_F(Lens, AStraightZoomMultipliesTheFocalLengthEvenly) {
    zoom({{0.0, 1.0}, {2.0, 0.3}}, PathInterpolation::Linear);
    const double ratio = focal(at(0.5)) / focal(at(0.0));
    EXPECT_GT(ratio, 1.0);
    for (const double t : {0.5, 1.0, 1.5})
        EXPECT_NEAR(focal(at(t + 0.5)) / focal(at(t)), ratio, 1e-12) << t;
}

TEST_F(Lens, ALensEasesLikeAPath) {
    zoom({{0.0, 1.0}, {2.0, 0.3}}, PathInterpolation::Linear, PathEase::InOut);
    const double whole = std::log(focal(0.3) / focal(1.0));
    EXPECT_NEAR(std::log(focal(at(0.5)) / focal(1.0)) / whole, 0.15625, 1e-12);
}

TEST_F(Lens, InterpolationBetweenTheWidestKeysIsAValidLens) {
    zoom({{0.0, 3.14}, {0.01, 1e-9}, {1.0, 1e-9}, {1.01, 3.14}, {5.0, 1e-3}});
    for (double t = -0.1; t < 5.2; t += 0.003) {
        ASSERT_GT(at(t), 0.0) << t;
        ASSERT_LT(at(t), std::numbers::pi) << t;
    }
}

TEST_F(Lens, ALensIsConstantBetweenEqualKeys) {
    zoom({{0.0, 0.123}, {1.0, 0.123}, {2.0, 0.123}});
    EXPECT_FALSE(mayZoom(mWorld, mCamera));
    for (double t = -0.5; t < 2.5; t += 0.0173)
        ASSERT_EQ(at(t), 0.123);
}

TEST_F(Lens, ACutJumps) {
    zoom({{0.0, 0.9}, {1.0, 0.8}, {2.0, 0.3, true}, {3.0, 0.2}});
    EXPECT_EQ(at(1.999), 0.8);
    EXPECT_EQ(at(2.0), 0.3);
    const auto& lens = mWorld.registry.get<LensMotion>(mCamera);
    EXPECT_TRUE(hasCutWithin(lens, 1.9, 2.0));
    EXPECT_FALSE(hasCutWithin(lens, 2.0, 2.1));
    // Within a frame in which the lens, or the path alone, jumps, nothing zooms.
    const ExposureMotion cut(mWorld, mCamera, computeExposure({0.1}, 2.01));
    EXPECT_TRUE(cut.isCut());
    EXPECT_EQ(cut.cameraYFov(0.0), at(2.01));
    EXPECT_EQ(cut.cameraYFov(1.0), at(2.01));
    EXPECT_FALSE(cut.mayCameraZoom());
}

TEST_F(Lens, ACutOfThePathHoldsTheLensInThatFrame) {
    zoom({{0.0, 0.9}, {4.0, 0.3}});
    PathMotion path;
    path.keys.resize(2);
    path.keys[1].seconds = 2.0;
    path.keys[1].cut = true;
    mWorld.registry.add(mCamera, path);
    const ExposureMotion cut(mWorld, mCamera, computeExposure({0.1}, 2.01));
    EXPECT_EQ(cut.cameraYFov(0.0), at(2.01));
    const ExposureMotion before(mWorld, mCamera, computeExposure({0.1}, 1.9));
    EXPECT_EQ(before.cameraYFov(0.0), at(before.exposure().open));
    EXPECT_NE(before.cameraYFov(0.0), before.cameraYFov(1.0));
    EXPECT_TRUE(before.mayCameraZoom());
}

TEST_F(Lens, BlurByZoomingScalesWithThatByTurning) {
    zoom({{0.0, 0.9}, {4.0, 0.3}});
    CameraShutter shutter{.exposureSeconds = 0.5};
    const auto lensAt = [&](double s) {
        return ExposureMotion(mWorld, mCamera, computeExposure(shutter, 2.0)).cameraYFov(s);
    };
    EXPECT_EQ(lensAt(0.0), at(1.5));
    shutter.cameraRotationScale = 0.5;
    EXPECT_EQ(lensAt(0.0), at(1.75));
    shutter.cameraRotationScale = 0.0;
    EXPECT_EQ(lensAt(0.0), at(2.0));
}

TEST_F(Lens, ExcludedEntitiesFollowTheZoom) {
    zoom({{0.0, 0.9}, {4.0, 0.3}});
    const ecs::Entity still = mWorld.registry.create();
    mWorld.registry.add(still, LocalTransform{{{1.0, 2.0, -5.0}, {1, 0, 0, 0}, math::dvec3(1.0)}});
    mWorld.registry.add(still, MotionBlur{.exclude = true});
    const ExposureMotion motion(mWorld, mCamera, computeExposure({0.5}, 2.0));
    EXPECT_TRUE(motion.mayObjectMove(still));
    const auto seen = [&](double s) {
        const math::dvec4 place = motion.worldFromObject(still, s)[3];
        return math::dvec2(place) / -place.z * focal(motion.cameraYFov(s));
    };
    EXPECT_NE(motion.worldFromObject(still, 0.0), motion.worldFromObject(still, 1.0));
    for (const double s : {0.0, 0.3, 0.7}) {
        EXPECT_NEAR(seen(s).x, seen(1.0).x, 1e-12);
        EXPECT_NEAR(seen(s).y, seen(1.0).y, 1e-12);
    }
}

TEST_F(Lens, AnOrthographicCameraHasNoLens) {
    zoom({{0.0, 0.9}, {4.0, 0.3}});
    mWorld.registry.get<Camera>(mCamera).kind = CameraKind::Orthographic;
    EXPECT_FALSE(mayZoom(mWorld, mCamera));
    EXPECT_EQ(at(2.0), 0.7);
}

TEST(LensKeys, WrongKeysAreNamed) {
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    const auto errorOf = [](std::vector<LensKey> keys) {
        const core::Status valid = validateLens({std::move(keys)});
        return valid.ok() ? std::string() : valid.error().message;
    };
    EXPECT_EQ(errorOf({{0.0, 0.5}}), "");
    EXPECT_NE(errorOf({}).find("no keys"), std::string::npos);
    EXPECT_NE(errorOf({{kNan, 0.5}}).find("time of key 0"), std::string::npos);
    EXPECT_NE(errorOf({{1.0, 0.5}, {1.0, 0.6}}).find("key 1 at 1 s"), std::string::npos);
    for (const double wrong : {0.0, -1.0, std::numbers::pi, kNan})
        EXPECT_NE(errorOf({{1.0, wrong}}).find("field of view of key 0"), std::string::npos);
}

} // namespace
} // namespace shutter::scene
