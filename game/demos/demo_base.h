// SPDX-License-Identifier: MIT
// The part that every demo has: a world in steps, cameras to switch, a body to exclude.
#pragma once

#include "game/demos/demo.h"

#include <cstdint>

namespace shutter::game {

class DemoBase : public Demo {
  public:
    [[nodiscard]] const scene::World& world() const final { return mWorld; }

    [[nodiscard]] scene::World& world() final { return mWorld; }

    [[nodiscard]] ecs::Entity camera() const final { return mWorld.cameras[mCamera]; }

    [[nodiscard]] double seconds() const final {
        return static_cast<double>(mSteps) / kDemoStepsPerSecond;
    }

    void step(const DemoControls& controls) final;
    [[nodiscard]] bool isBodyExcluded() const final;

  protected:
    /// \param world has a camera
    /// \param body whose exclusion from the blur the player toggles
    DemoBase(scene::World world, ecs::Entity body);

    /// The rules and the physics of one step, which ends at seconds().
    virtual void simulate(const DemoControls& controls) = 0;
    /// The picture changes to the next camera.
    void cutToNextCamera();
    /// To be called once when all is in its place: motion begins here.
    void recordStart();

  private:
    scene::World mWorld;
    ecs::Entity mBody;
    uint64_t mSteps = 0;
    size_t mCamera = 0; ///< of World::cameras
};

} // namespace shutter::game
