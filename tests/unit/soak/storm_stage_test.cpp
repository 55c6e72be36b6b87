// SPDX-License-Identifier: MIT
#include "engine/scene/motion.h"
#include "game/soak/storm_stage.h"
#include "tests/kit/scene_builder.h"

#include <gtest/gtest.h>

namespace shutter::game {
namespace {

/// A box before a camera, on which nobody plays.
class Bare : public Stage {
  public:
    Bare() {
        const scene::AssetIndex color = mScene.addColor(math::vec3(1.0f));
        mScene.add(test::makeBox(math::dvec3(0.5), color), {.position = {0.0, 0.0, -3.0}});
    }

    [[nodiscard]] std::string title() const override { return "bare"; }

    [[nodiscard]] scene::World& world() override { return mScene.world; }

    [[nodiscard]] ecs::Entity camera() const override { return mScene.camera; }

    [[nodiscard]] DemoLook look() const override { return {}; }

    void advance(const app::InputState&, const StageFrame&) override {}

    [[nodiscard]] std::vector<HudLine> hud() const override { return {}; }

  private:
    test::SceneBuilder mScene;
};

void advance(Stage& stage, uint32_t frame, bool paused = false) {
    StageFrame next;
    next.time.seconds = frame / 30.0;
    next.paused = paused;
    stage.advance({}, next);
}

TEST(StormStage, ThingsComeAndAllGoAgain) {
    const auto stage = makeStormStage(std::make_unique<Bare>(), 40);
    const size_t before = stage->world().registry.aliveCount();
    for (uint32_t frame = 0; frame < 10 * kStormFrames; ++frame) {
        advance(*stage, frame);
        const bool storms = frame % kStormFrames < kStormFrames / 2;
        EXPECT_EQ(stage->world().registry.aliveCount(), before + (storms ? 40 : 0)) << frame;
    }
}

TEST(StormStage, ThingsAppearBeforeTheCameraAndHalfOfThemMove) {
    const auto stage = makeStormStage(std::make_unique<Bare>(), 40);
    for (uint32_t frame = 0; frame <= 100 * kStormFrames; ++frame)
        advance(*stage, frame);
    const double now = 100 * kStormFrames / 30.0;
    const scene::World& world = stage->world();
    uint32_t moving = 0;
    for (auto [entity, appeared] : world.registry.view<scene::Appeared>()) {
        const math::dvec3 place(scene::worldFromEntity(world, entity, now)[3]);
        EXPECT_LT(place.z, 0.0);
        EXPECT_GT(place.z, -12.01);
        moving += world.registry.has<scene::LinearVelocity>(entity);
    }
    EXPECT_EQ(moving, 20u);
}

TEST(StormStage, APauseIsNoPartOfAStorm) {
    const auto stage = makeStormStage(std::make_unique<Bare>(), 40);
    const size_t before = stage->world().registry.aliveCount();
    for (uint32_t frame = 0; frame < kStormFrames; ++frame)
        advance(*stage, frame, true);
    EXPECT_EQ(stage->world().registry.aliveCount(), before);
}

} // namespace
} // namespace shutter::game
