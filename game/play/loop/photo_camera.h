// SPDX-License-Identifier: MIT
// The camera of photo mode: it hangs on the one that the picture was seen through, so that it blurs
// as that does wherever the player takes it.
#pragma once

#include "engine/app/camera_control.h"
#include "engine/scene/world.h"

#include <optional>

namespace shutter::game {

class PhotoCamera {
  public:
    /// Creates its entity where `stageCamera` is; a camera that is out already stays as it is.
    /// \param seconds of the picture, at which the world stands still
    void take(scene::World& world, ecs::Entity stageCamera, double seconds);

    /// Destroys its entity, if there is one.
    void putBack(scene::World& world);

    [[nodiscard]] bool isOut() const { return mOut.has_value(); }

    /// It must be out (CHECKed).
    [[nodiscard]] ecs::Entity entity() const;

    /// Flies as the player wants, out or not. \param heightPx of the window, above 0
    void
    advance(scene::World& world, const app::InputState& input, double wallSeconds, double heightPx);

  private:
    struct Out {
        ecs::Entity entity;
        math::dmat4 stageFromWorld{1.0};
        math::dmat4 rest{1.0}; ///< where it is until it is moved, from the stage's camera
        app::FlyView start;
        app::FlyView view;
    };

    std::optional<Out> mOut;
};

} // namespace shutter::game
