// SPDX-License-Identifier: MIT
// `rally`: two laps by car, against the clock, past posts that should not be hit.
#pragma once

#include "game/demos/demo_base.h"
#include "game/demos/rally_car.h"
#include "game/demos/rally_track.h"

#include <array>
#include <memory>
#include <vector>

namespace shutter::game {

class RallyDemo final : public DemoBase {
  public:
    /// \param file names the scene in messages
    [[nodiscard]] static core::Result<std::unique_ptr<Demo>>
    create(scene::World world, std::string_view file);

    [[nodiscard]] const char* name() const override { return "rally"; }

    [[nodiscard]] DemoAppearance appearance() const override;
    [[nodiscard]] std::vector<HudLine> hud() const override;
    [[nodiscard]] bool isOver() const override;
    [[nodiscard]] int score() const override;

    [[nodiscard]] const CarState& car() const { return world().registry.get<CarState>(mCar); }

    [[nodiscard]] const RallyTrack& track() const { return mTrack; }

    [[nodiscard]] const RallyProgress& progress() const { return mProgress; }

  protected:
    void simulate(const DemoControls& controls) override;

  private:
    struct Wheel {
        ecs::Entity tyre;   ///< fixed to the car and steered
        ecs::Entity spokes; ///< roll in it
        math::Transform rest;
        bool isFront = false;
    };

    struct Nodes {
        ecs::Entity car;
        ecs::Entity body;
        ecs::Entity chase;
        std::array<Wheel, 4> wheels;
    };

    RallyDemo(scene::World world, const Nodes& nodes, RallyTrack track, std::vector<Fence> fences);
    /// Behind rear wheels that slide or run off the road.
    void raiseDust(const CarState& state);
    void placeCar();

    ecs::Entity mCar;
    Nodes mNodes;
    math::Transform mBodyRest;
    RallyTrack mTrack;
    std::vector<Fence> mFences;
    ChaseCamera mChase;
    RallyProgress mProgress;
    int mPostsHit = 0;
    double mEndSeconds = 0.0; ///< when the race was over; 0: it is not
};

} // namespace shutter::game
