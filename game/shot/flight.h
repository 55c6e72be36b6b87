// SPDX-License-Identifier: MIT
// `--flythrough`: a camera and the frames of a whole flight through the scene, from a file
// (flythrough.schema.json) or from one of the scene's own clips (`clip:NAME`).
#pragma once

#include "engine/core/result.h"
#include "engine/ecs/entity.h"
#include "engine/scene/world.h"
#include "game/shot/shot_options.h"

namespace shutter::game {

/// Sets frameTimes and firstFrame: frames `first` to `last`, both included, at `options.fps`.
/// Error: names `option`; there are too many frames, or they lie beyond the times that count.
[[nodiscard]] core::Status
planFrames(const char* option, double first, double last, ShotOptions& options);

/// Plans every frame whose time, in seconds, lies in the flight, both ends included; at least one.
[[nodiscard]] core::Status planWholeFlight(double from, double to, ShotOptions& options);

/// The camera that the clip `options.flythroughClip` moves: --camera's, or the first. Other clips
/// that drive this camera or its parents no longer play. Error: there is no such clip or camera.
[[nodiscard]] core::Result<ecs::Entity>
chooseClipCamera(scene::World& world, const ShotOptions& options);

/// Plans the frames of the whole clip, unless --frames did.
[[nodiscard]] core::Status planClipFrames(const scene::World& world, ShotOptions& options);

} // namespace shutter::game
