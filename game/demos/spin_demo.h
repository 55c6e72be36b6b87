// SPDX-License-Identifier: MIT
// `spin`: a carousel, a fan and a wind wheel on one shaft; keep the rate, catch the ring.
#pragma once

#include "game/demos/demo_base.h"
#include "game/demos/random.h"
#include "game/demos/spin_ride.h"
#include "modules/particles/particle_emitter.h"

#include <memory>
#include <vector>

namespace shutter::game {

class SpinDemo final : public DemoBase {
  public:
    /// \param file names the scene in messages
    [[nodiscard]] static core::Result<std::unique_ptr<Demo>>
    create(scene::World world, std::string_view file);

    [[nodiscard]] const char* name() const override { return "spin"; }

    [[nodiscard]] DemoAppearance appearance() const override;
    [[nodiscard]] std::vector<HudLine> hud() const override;
    [[nodiscard]] bool isOver() const override;

    [[nodiscard]] int score() const override { return countPoints(mRules); }

    [[nodiscard]] const Ride& ride() const { return mRide; }

    [[nodiscard]] const RideRules& rules() const { return mRules; }

  protected:
    void simulate(const DemoControls& controls) override;

  private:
    struct Part {
        ecs::Entity entity;
        math::Transform rest;
    };

    struct Parts {
        Part carousel;
        Part fan;
        Part mill;
        Part front; ///< camera
        ecs::Entity hub;
        ecs::Entity ring;
        std::vector<Part> seats;
    };

    SpinDemo(scene::World world, Parts parts);
    /// Something that emits there, relative to `parent`; null: to the world.
    ecs::Entity
    addEmitter(ecs::Entity parent, const math::dvec3& place, particles::ParticleEmitter emitter);
    void placeParts();

    Parts mParts;
    ecs::Entity mRingSparks;
    ecs::Entity mBrakeSparks;
    Ride mRide;
    RideRules mRules;
    Random mRandom{3};
    double mOrbit = 0.0; ///< radians that the front camera has gone round the carousel
};

} // namespace shutter::game
