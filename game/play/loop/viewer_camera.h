// SPDX-License-Identifier: MIT
// The camera in the player's hand, and the way it took, which its blur follows.
#pragma once

#include "engine/app/camera_control.h"
#include "engine/scene/world.h"

#include <deque>

namespace shutter::game {

enum class ViewerMode : uint8_t { Orbit, Fly };

class ViewerCamera {
  public:
    /// Creates its entity as a copy of `like`, placed and focused as that is at `seconds`.
    /// \param distance to the target, metres, above 0
    ViewerCamera(scene::World& world, ecs::Entity like, double distance, double seconds);

    [[nodiscard]] ecs::Entity entity() const { return mEntity; }

    [[nodiscard]] ViewerMode mode() const { return mMode; }

    /// Continues from where it is.
    void setMode(ViewerMode mode);
    /// Jumps to a placement and clears its recorded motion. \param placement in world space
    void jumpTo(const math::Transform& placement);

    [[nodiscard]] math::Transform placement() const;

    /// Moves by the player's input and records its motion in the world. While the game is paused,
    /// an untouched camera preserves its last motion, and so its blur.
    /// \param seconds game time of the frame \param duration game time of a frame, above 0
    void advance(
        scene::World& world,
        const app::InputState& input,
        double seconds,
        double duration,
        double wallSeconds,
        double heightPx,
        bool paused
    );

  private:
    /// Where it was, and how long before the frame now.
    struct Stop {
        math::Transform placement;
        double age = 0.0; ///< seconds of game time
    };

    ecs::Entity mEntity;
    ViewerMode mMode = ViewerMode::Orbit;
    app::OrbitView mOrbit;
    app::FlyView mFly;
    std::deque<Stop> mWay; ///< newest first
};

} // namespace shutter::game
