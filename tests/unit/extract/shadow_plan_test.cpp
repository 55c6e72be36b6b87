// SPDX-License-Identifier: MIT
// Which maps a frame's shadows come from.
#include "engine/extract/shadow_plan.h"
#include "tests/unit/extract/extraction_fixture.h"

#include <cmath>

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
        const ShadowPlan plan = planShadows(world, layout, request, extract(), false);
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
    // Its box says nothing of how near what surrounds the camera comes.
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
    const ShadowPlan plan = planShadows(world, layout, request, extract(), false);
    ASSERT_EQ(plan.movers.size(), 2u);
    const uint32_t first = plan.lights.at(0).firstLayer;
    const uint32_t near = plan.maps.at(first + plan.movers[0].firstLayer).sizePx;
    const uint32_t far = plan.maps.at(first + plan.movers[1].firstLayer).sizePx;
    // Its sphere's width, 1.7 metres, is 40 pixels at 4 metres.
    EXPECT_EQ(near, 128u);
    EXPECT_EQ(far, 16u);
    request.shadows.mapSize = 256;
    const ShadowPlan small = planShadows(world, layout, request, extract(), false);
    EXPECT_EQ(small.maps.at(small.lights.at(0).firstLayer + small.movers[0].firstLayer).sizePx, 64u)
        << "a quarter at most";
}

TEST_F(ShadowPlanOfScenes, AMoverAroundTheCameraHasTheLargestLayer) {
    const ecs::Entity mover = addBox(dvec3(0, 0, 0));
    world.registry.add(mover, scene::LinearVelocity{dvec3(0.2, 0, 0)});
    const ShadowPlan plan = planShadows(world, layout, request, extract(), false);
    ASSERT_EQ(plan.movers.size(), 1u);
    EXPECT_EQ(plan.maps.back().sizePx, request.shadows.mapSize / 4);
}

TEST_F(ShadowPlanOfScenes, WhatIsFlatHasFewerLayersThanACube) {
    request.shadows.mode = ShadowMode::Blurred;
    for (const dvec3 scale : {dvec3(1.0), dvec3(0.9, 0.9, 0.1)}) {
        const ecs::Entity mover =
            addBox(math::Transform{.translation = dvec3(0, 0, -9), .scale = scale});
        world.registry.add(mover, scene::AngularVelocity{dvec3(0, 0, 0.9)});
    }
    const ShadowPlan plan = planShadows(world, layout, request, extract(), false);
    ASSERT_EQ(plan.movers.size(), 2u);
    EXPECT_LT(plan.movers[1].partCount, plan.movers[0].partCount);
}

TEST_F(ShadowPlanOfScenes, RunsAreAsShortAsAnyLightAsks) {
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
        return planShadows(world, layout, request, extract(), false).movers.at(0).runInstants;
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
    const ShadowPlan plan = planShadows(world, layout, request, extract(), false);
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

} // namespace

} // namespace shutter::extract
