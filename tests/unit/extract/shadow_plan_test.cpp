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

} // namespace

} // namespace shutter::extract
