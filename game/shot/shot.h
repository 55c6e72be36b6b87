// SPDX-License-Identifier: MIT
// A scene with the camera, clips and shutter a person asked for.
#pragma once

#include "engine/core/result.h"
#include "engine/extract/extracted_frame.h"
#include "engine/scene/world.h"
#include "game/shot/shot_options.h"

namespace shutter::game {

struct Shot {
    scene::World world;
    ecs::Entity camera;
};

/// The camera that --camera names, the first, or one made to fit.
[[nodiscard]] core::Result<ecs::Entity> findCamera(scene::World& world, const ShotOptions& options);

/// Loads the scene (its warnings are logged), picks or makes the camera (a flythrough flies its
/// own), puts the shutter on it, selects clips, and lights a scene that has no light of its own.
[[nodiscard]] core::Result<Shot> loadShot(const ShotOptions& options);

/// The shot's view of the frame at `seconds`.
[[nodiscard]] extract::ViewRequest
makeView(const Shot& shot, const ShotOptions& options, double seconds);

} // namespace shutter::game
