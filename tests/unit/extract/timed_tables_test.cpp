// SPDX-License-Identifier: MIT
#include "engine/extract/frame_extractor.h"
#include "engine/extract/timed_tables.h"
#include "engine/scene/auto_focus.h"
#include "engine/scene/path.h"
#include "tests/unit/extract/extraction_fixture.h"

namespace shutter::extract {
namespace {

class TimedLens : public Extraction {
  protected:
    TimedLens() {
        request.usesLens = true;
        world.registry.add(camera, scene::CameraLens{.fStop = 2.0, .focusDistance = 5.0});
    }

    std::vector<shader::LensKey> compute() {
        ExtractedFrame frame = extract();
        auto tables = computeTimedTables(world, layout, request, frame);
        EXPECT_TRUE(tables.ok());
        return tables.value().lens;
    }
};

TEST_F(TimedLens, OneThatNothingFocusesHasOneKey) {
    const auto lens = compute();
    ASSERT_EQ(lens.size(), 1u);
    EXPECT_FLOAT_EQ(lens[0].focus, 0.2f);
}

TEST_F(TimedLens, APullOfTheAutofocusIsSeenOverTheExposure) {
    constexpr size_t kIntervals = 64;
    const ecs::Entity target = world.registry.create();
    scene::PathMotion way{{{0.0, {0, 0, -2}}, {1.0, {0, 0, -8}}}, scene::PathInterpolation::Linear};
    for (scene::PathKey& key : way.keys)
        key.rotation = math::dquat(1.0, 0.0, 0.0, 0.0);
    world.registry.add(target, std::move(way));
    world.registry.add(camera, scene::AutoFocus{target, 0.0});
    scene::advanceAutoFocus(world, 0.0);
    scene::advanceAutoFocus(world, 1.0);
    const auto lens = compute();
    ASSERT_EQ(lens.size(), kIntervals + 1);
    EXPECT_FLOAT_EQ(lens.front().focus, 1.0f / 2.0f);
    EXPECT_NEAR(lens[kIntervals / 2].focus, 1.0f / 5.0f, 1e-4f);
    EXPECT_FLOAT_EQ(lens.back().focus, 1.0f / 8.0f);
}

} // namespace
} // namespace shutter::extract
