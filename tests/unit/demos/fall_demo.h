// SPDX-License-Identifier: MIT
// The demo that game/demos/README.md shows (tests/docs/quotes_test.py).
#pragma once

#include "game/demos/demo_base.h"
#include "game/demos/random.h"
#include "game/demos/stage.h"

#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace shutter::game {

class FallDemo final : public DemoBase {
  public:
    static core::Result<std::unique_ptr<Demo>> create(scene::World world, std::string_view file) {
        NodeNames names(world);
        const ecs::Entity ball = names.find("ball");
        SHUTTER_TRY(names.check(file)); // the error names the file and the node that it lacks
        if (world.cameras.empty())
            return core::makeError("{}: it has no camera", file);
        return std::unique_ptr<Demo>(new FallDemo(std::move(world), ball));
    }

    const char* name() const override { return "fall"; }

    DemoAppearance appearance() const override { return {.turbidity = 2.0}; }

    std::vector<HudLine> hud() const override { // text, whether it is emphasised, label
        return {{std::to_string(mFalls), true, "Falls"}};
    }

    bool isOver() const override { return seconds() > 30.0; }

    int score() const override { return mFalls; }

  protected:
    // One step of kDemoStepSeconds, 1/120 s. controls.turn and drive are -1 to 1, the others bool.
    void simulate(const DemoControls& controls) override {
        auto& pose = world().registry.get<SimulatedPose>(mBall);
        math::dvec3& place = pose.transform.translation;
        mSpeed -= kGravity * kDemoStepSeconds; // 9.81 m/s^2
        place += math::dvec3(controls.turn, mSpeed, 0.0) * kDemoStepSeconds;
        pose.jumped = place.y < 0.0; // put elsewhere, not moved there: nothing blurs in between
        if (pose.jumped) {
            place = {mRandom.between(-2.0, 2.0), 5.0, 0.0};
            mSpeed = 0.0;
            mFalls += isOver() ? 0 : 1;
        }
    }

  private:
    FallDemo(scene::World loaded, ecs::Entity ball)
        : DemoBase(std::move(loaded), ball), // ball: what E takes out of the blur
          mBall(ball) {
        (void)game::simulate(world(), ball); // of stage.h: gives it a SimulatedPose, at rest
        recordStart();                       // once all is in its place
    }

    ecs::Entity mBall;
    Random mRandom{1}; // the same numbers in every run
    double mSpeed = 0.0;
    int mFalls = 0;
};

} // namespace shutter::game
