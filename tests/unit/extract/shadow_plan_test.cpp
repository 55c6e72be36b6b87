// SPDX-License-Identifier: MIT
// The maps of a frame's shadows, their views, and their stability.
#include "engine/extract/shadow_plan.h"
#include "engine/extract/shadow_views.h"
#include "shaders/render/shadow_filter.glsl"
#include "tests/unit/extract/extraction_fixture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace shutter::extract {
namespace {

using math::dvec3;
using math::dvec4;

class ShadowPlanOfScenes : public Extraction {
  protected:
    ShadowPlanOfScenes() {
        request.shadows.mode = ShadowMode::Sharp;
        math::Transform down;
        down.rotation = glm::angleAxis(-1.2, dvec3(1, 0, 0));
        const ecs::Entity sun = world.registry.create();
        world.registry.add(sun, scene::LocalTransform{down});
        world.registry.add(sun, scene::Light{.kind = scene::LightKind::Directional});
        addBox(dvec3(0, 0, -9)); // begins 8 metres before the camera
        addBox(dvec3(0, 0, -129));
    }

    /// Whether the finest cascade reaches the back of the nearest box.
    bool isNearestInFinest() {
        const ShadowPlan plan =
            planShadows(world, layout, request, FrameView(world, request), extract(), false);
        EXPECT_TRUE(plan.shadows.run) << plan.shadows.reason;
        EXPECT_GT(plan.maps.size(), 1u);
        if (plan.maps.empty())
            return false;
        const dvec4 clip = plan.maps.front().view.clipFromWorld * dvec4(0, 0, -9.9, 1);
        return std::abs(clip.x) < 1.0 && std::abs(clip.y) < 1.0;
    }
};

TEST_F(ShadowPlanOfScenes, CascadesBeginWhereTheSceneDoes) {
    EXPECT_TRUE(isNearestInFinest());
    // A box that surrounds the camera gives no bound for the distance.
    addBox(math::Transform{.translation = dvec3(0), .scale = dvec3(60.0)});
    EXPECT_TRUE(isNearestInFinest());
    addBox(math::Transform{.translation = dvec3(0, 0, -1.5), .scale = dvec3(0.1)});
    EXPECT_FALSE(isNearestInFinest()) << "the cascades do not begin at what came nearer";
}

TEST_F(ShadowPlanOfScenes, LayersAreAsLargeAsTheirMoversAreSeen) {
    request.shadows.mode = ShadowMode::Blurred;
    request.shadows.mapSize = 2048;
    for (const double distance : {4.0, 60.0}) {
        const ecs::Entity mover =
            addBox(math::Transform{.translation = dvec3(0, 0, -distance), .scale = dvec3(0.5)});
        world.registry.add(mover, scene::LinearVelocity{dvec3(0.2, 0, 0)});
    }
    const ShadowPlan plan =
        planShadows(world, layout, request, FrameView(world, request), extract(), false);
    ASSERT_EQ(plan.movers.size(), 2u);
    const uint32_t first = plan.lights.at(0).firstLayer;
    const uint32_t near = plan.maps.at(first + plan.movers[0].firstLayer).sizePx;
    const uint32_t far = plan.maps.at(first + plan.movers[1].firstLayer).sizePx;
    // Its sphere's width, 1.7 metres, is 40 pixels at 4 metres.
    EXPECT_EQ(near, 128u);
    EXPECT_EQ(far, 16u);
    request.shadows.mapSize = 256;
    const ShadowPlan small =
        planShadows(world, layout, request, FrameView(world, request), extract(), false);
    EXPECT_EQ(small.maps.at(small.lights.at(0).firstLayer + small.movers[0].firstLayer).sizePx, 64u)
        << "a quarter at most";
}

TEST_F(ShadowPlanOfScenes, AMoverAroundTheCameraHasTheLargestLayer) {
    const ecs::Entity mover = addBox(dvec3(0, 0, 0));
    world.registry.add(mover, scene::LinearVelocity{dvec3(0.2, 0, 0)});
    const ShadowPlan plan =
        planShadows(world, layout, request, FrameView(world, request), extract(), false);
    ASSERT_EQ(plan.movers.size(), 1u);
    EXPECT_EQ(plan.maps.back().sizePx, request.shadows.mapSize / 4);
}

TEST_F(ShadowPlanOfScenes, FlatMoversHaveFewerLayersThanACube) {
    request.shadows.mode = ShadowMode::Blurred;
    for (const dvec3 scale : {dvec3(1.0), dvec3(0.9, 0.9, 0.1)}) {
        const ecs::Entity mover =
            addBox(math::Transform{.translation = dvec3(0, 0, -9), .scale = scale});
        world.registry.add(mover, scene::AngularVelocity{dvec3(0, 0, 0.9)});
    }
    const ShadowPlan plan =
        planShadows(world, layout, request, FrameView(world, request), extract(), false);
    ASSERT_EQ(plan.movers.size(), 2u);
    EXPECT_LT(plan.movers[1].partCount, plan.movers[0].partCount);
}

TEST_F(ShadowPlanOfScenes, RunsAreAsShortAsAnyLightRequires) {
    request.shadows.mode = ShadowMode::Blurred;
    request.shadows.mapSize = 4096;
    const ecs::Entity turning =
        addBox(math::Transform{.translation = dvec3(2, 0, -40), .scale = dvec3(1.0, 1.0, 0.1)});
    world.registry.add(turning, scene::AngularVelocity{dvec3(0, 0, 0.8)});
    const auto addLight = [&](const dvec3& direction) {
        const ecs::Entity light = world.registry.create();
        const math::dquat turn = glm::quatLookAt(glm::normalize(direction), dvec3(1, 0, 0));
        world.registry.add(light, scene::LocalTransform{{.rotation = turn}});
        world.registry.add(light, scene::Light{.kind = scene::LightKind::Directional});
    };
    const auto runInstants = [&] {
        return planShadows(world, layout, request, FrameView(world, request), extract(), false)
            .movers.at(0)
            .runInstants;
    };
    addBox(dvec3(0, -3, 0)); // the scene reaches to the camera
    const uint32_t alone = runInstants();
    addLight({-0.05, -0.01, 1.0}); // which takes the shadow to the camera, and needs a large layer
    const uint32_t both = runInstants();
    EXPECT_LT(both, alone);
    addLight({0, -1, 0});
    EXPECT_EQ(runInstants(), both);
}

TEST_F(ShadowPlanOfScenes, MoversHaveRunsBeforeEachLightThatIsFarAway) {
    request.shadows.mode = ShadowMode::Blurred;
    request.shadows.instants = 10;
    const ecs::Entity lamp = world.registry.create();
    world.registry.add(lamp, scene::LocalTransform{{.translation = dvec3(0, 30, 0)}});
    world.registry.add(lamp, scene::Light{.kind = scene::LightKind::Point});
    const ecs::Entity moon = world.registry.create();
    world.registry.add(
        moon, scene::LocalTransform{{.rotation = glm::angleAxis(-0.7, dvec3(1, 0, 0))}}
    );
    world.registry.add(moon, scene::Light{.kind = scene::LightKind::Directional});
    const ecs::Entity turning = addBox(dvec3(2, 0, -9));
    world.registry.add(turning, scene::AngularVelocity{dvec3(0, 1.0, 0)});
    const ecs::Entity straight = addBox(dvec3(-2, 0, -12));
    world.registry.add(straight, scene::LinearVelocity{dvec3(1, 0, 0)});
    const ShadowPlan plan =
        planShadows(world, layout, request, FrameView(world, request), extract(), false);
    ASSERT_EQ(plan.movers.size(), 2u);
    EXPECT_LT(plan.movers[0].runInstants, plan.movers[1].runInstants);
    EXPECT_EQ(plan.movers[1].runInstants, shader::kMaxRunInstants);
    EXPECT_EQ(plan.movers[1].firstRun, 1u + 12u / plan.movers[0].runInstants);
    uint32_t far = 0;
    for (const shader::ShadowLight& light : plan.lights)
        if (light.firstRun != shader::kNoShadowRun) {
            EXPECT_EQ(light.firstRun, far++ * plan.runs.size() / 2);
        }
    EXPECT_EQ(far, 2u) << "the lamp has no runs, sun and moon have";
    EXPECT_EQ(plan.runs.size(), 2 * (plan.movers[1].firstRun + 1u + 3u));
}

constexpr uint32_t kSize = 512;
const dvec3 kToSun = glm::normalize(dvec3(0.4, 1.0, 0.3));

math::Bounds makeBox(double half) {
    math::Bounds box;
    box.add(dvec3(-half, -0.1 * half, -half));
    box.add(dvec3(half, 0.3 * half, half));
    return box;
}

CameraSlice makeCamera(const dvec3& eye = {0.0, 1.0, 0.0}) {
    return {eye, glm::normalize(dvec3(0.1, -0.1, -1.0)), 0.7, true, 0.05};
}

bool isInside(const LightView& view, const dvec3& point) {
    const dvec4 clip = view.clipFromWorld * dvec4(point, 1.0);
    return clip.w > 0.0 && std::abs(clip.x) <= clip.w && std::abs(clip.y) <= clip.w;
}

TEST(ShadowViews, ASlicesSphereHoldsItsCornersAndIsNoLargerThanNeeded) {
    for (const auto& [from, to] : {std::pair{0.1, 1.0}, {1.0, 1.2}, {5.0, 80.0}}) {
        const CameraSlice camera{{1, 2, 3}, {0, 0, -1}, 0.8, true, 0.05};
        const Sphere sphere = boundSlice(camera, from, to);
        double reach = 0.0;
        for (const double at : {from, to})
            for (const double side : {-1.0, 1.0})
                reach = std::max(
                    reach,
                    glm::length(
                        camera.eye + dvec3(side * at * camera.cornerReach, 0.0, -at) - sphere.centre
                    )
                );
        EXPECT_NEAR(reach, sphere.radius, 1e-9 * to);
    }
}

TEST(ShadowViews, CascadesGrowAndTheLastHasTheWholeScene) {
    const auto views = fitCascades(makeCamera(), kToSun, makeBox(20.0), 40.0, kSize);
    ASSERT_GE(views.size(), 2u);
    ASSERT_LE(views.size(), size_t{kMaxCascades});
    for (size_t i = 1; i < views.size(); ++i)
        EXPECT_GT(views[i].texelMetres, views[i - 1].texelMetres);
    for (const double x : {-20.0, 20.0})
        for (const double z : {-20.0, 20.0})
            EXPECT_TRUE(isInside(views.back(), {x, 0.0, z})) << x << ", " << z;
}

TEST(ShadowViews, EachCascadeReachesTheSameNumberOfTimesAsFarAsTheOneBefore) {
    CameraSlice camera = makeCamera();
    camera.near = 4.0;
    const auto views = fitCascades(camera, kToSun, makeBox(5000.0), 1024.0, kSize);
    ASSERT_EQ(views.size(), size_t{kMaxCascades});
    // Four times, give or take the rounding of their widths to quarters of a power of two.
    for (size_t i = 1; i < views.size(); ++i)
        EXPECT_NEAR(std::log2(views[i].texelMetres / views[i - 1].texelMetres), 2.0, 0.26) << i;
}

TEST(ShadowViews, ACascadeStaysWhileTheCameraMovesALittleAndThenMovesByWholeTexels) {
    const math::Bounds scene = makeBox(500.0);
    const auto before = fitCascades(makeCamera(), kToSun, scene, 1000.0, kSize);
    size_t stayed = 0;
    for (int step = 1; step <= 40; ++step) {
        const auto after =
            fitCascades(makeCamera({0.01 * step, 1.0, 0.02 * step}), kToSun, scene, 1000.0, kSize);
        ASSERT_EQ(after.size(), before.size());
        for (size_t i = 0; i < after.size(); ++i) {
            ASSERT_EQ(after[i].texelMetres, before[i].texelMetres);
            stayed += after[i].clipFromWorld == before[i].clipFromWorld;
            const dvec4 shift = after[i].clipFromWorld[3] - before[i].clipFromWorld[3];
            for (const double clip : {shift.x, shift.y}) {
                const double texels = clip * 0.5 * kSize;
                EXPECT_NEAR(texels, std::round(texels), 1e-6);
            }
        }
    }
    EXPECT_GT(stayed, 40u * before.size() * 3 / 4);
}

TEST(ShadowViews, TurningTheCameraLeavesCascadesTheirSize) {
    CameraSlice camera = makeCamera();
    const auto before = fitCascades(camera, kToSun, makeBox(500.0), 1000.0, kSize);
    camera.forward = glm::normalize(dvec3(0.9, 0.2, 0.4));
    const auto after = fitCascades(camera, kToSun, makeBox(500.0), 1000.0, kSize);
    ASSERT_EQ(after.size(), before.size());
    for (size_t i = 0; i < after.size(); ++i)
        EXPECT_EQ(after[i].texelMetres, before[i].texelMetres);
}

TEST(ShadowViews, CascadesFollowTheScalesOfScenes) {
    // Scales near a centimetre and a kilometre that are powers of two, so that nothing else
    // differs.
    for (const double scale : {1.0 / 128.0, 1024.0}) {
        CameraSlice camera = makeCamera();
        const auto before = fitCascades(camera, kToSun, makeBox(16.0), 32.0, kSize);
        camera.eye *= scale;
        camera.near *= scale;
        const auto after = fitCascades(camera, kToSun, makeBox(16.0 * scale), 32.0 * scale, kSize);
        ASSERT_EQ(after.size(), before.size());
        for (size_t i = 0; i < after.size(); ++i)
            EXPECT_NEAR(after[i].texelMetres / scale, before[i].texelMetres, 1e-9);
    }
}

TEST(ShadowViews, EachDirectionIsInTheMiddleOfItsFaceOfACube) {
    const dvec3 light(3.0, -1.0, 2.0);
    const auto faces = fitCube(light, 0.01, kSize);
    for (int i = 0; i < 500; ++i) {
        const dvec3 direction(std::sin(i * 1.3), std::cos(i * 2.1), std::sin(i * 0.7 + 1.0));
        const dvec3 point = light + 5.0 * direction;
        const LightView& face = faces.at(shader::cubeFace(math::vec3(direction)));
        const auto place = shader::placeInMap(
            math::vec4(face.clipFromWorld * dvec4(point, 1.0)), math::vec2(0.0f), kSize
        );
        EXPECT_TRUE(place.isCovered) << i;
    }
}

TEST(ShadowViews, ALayerHoldsItsSphere) {
    const Sphere mover{{4.0, 1.0, -3.0}, 0.7};
    const dvec3 light(0.0, 6.0, 0.0);
    ASSERT_TRUE(fitsPointLayer(light, mover));
    EXPECT_FALSE(fitsPointLayer(mover.centre + dvec3(0.9, 0.0, 0.0), mover));
    for (const LightView& view : {fitLayer(kToSun, mover, 128), fitPointLayer(light, mover, 128)})
        for (int i = 0; i < 200; ++i) {
            const dvec3 way =
                glm::normalize(dvec3(std::sin(i * 1.3), std::cos(i * 2.1), std::sin(i * 0.7)));
            const dvec3 point = mover.centre + mover.radius * way;
            EXPECT_TRUE(isInside(view, point)) << i;
            const dvec4 clip = view.clipFromWorld * dvec4(point, 1.0);
            EXPECT_GT(clip.z / clip.w, 0.0);
            EXPECT_LE(clip.z / clip.w, 1.0);
        }
}

TEST(ShadowViews, ASpotsMapHoldsItsCone) {
    const dvec3 direction = glm::normalize(dvec3(0.2, -1.0, 0.1));
    const LightView view = fitSpot({0, 4, 0}, direction, 0.6, 0.01, kSize);
    const dvec3 side = glm::normalize(glm::cross(direction, dvec3(1, 0, 0)));
    for (int i = 0; i < 64; ++i) {
        const dvec3 turned =
            side * std::cos(i * 0.1) + glm::cross(direction, side) * std::sin(i * 0.1);
        const dvec3 point =
            dvec3(0, 4, 0) + 3.0 * (direction * std::cos(0.59) + turned * std::sin(0.59));
        EXPECT_TRUE(isInside(view, point)) << i;
    }
}

} // namespace
} // namespace shutter::extract
