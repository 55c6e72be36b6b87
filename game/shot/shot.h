// SPDX-License-Identifier: MIT
// A scene with the camera, clips and shutter that the options name, and the frames of a flight
// through it (`--flythrough`): from a file (flythrough.schema.json) or from one of the scene's own
// clips (`clip:NAME|INDEX`).
#pragma once

#include "engine/core/result.h"
#include "engine/ecs/entity.h"
#include "engine/extract/extracted_frame.h"
#include "engine/scene/world.h"
#include "game/shot/shot_options.h"

#include <optional>

namespace shutter::game {

struct Shot {
    scene::World world;
    ecs::Entity camera;
    /// When the camera was made to fit, seconds; nothing: the scene or a flythrough has one.
    std::optional<double> framedAt;
};

/// The camera that --camera names, the first, or one made to fit.
[[nodiscard]] core::Result<ecs::Entity> findCamera(scene::World& world, const ShotOptions& options);

/// Loads the scene (its warnings are logged), picks or makes the camera (a flythrough flies its
/// own), puts the shutter on it, selects clips, and lights a scene that has no lights.
[[nodiscard]] core::Result<Shot> loadShot(const ShotOptions& options);

/// The option by which the options focus the camera: "--focus" or "--focus-entity".
[[nodiscard]] const char* nameFocusOption(const ShotOptions& options);

/// Focuses the camera and those of the world on the entity that `options.focusEntity` names; does
/// nothing without a name. Error: names the option, `source` and the name, which no entity or
/// several have.
/// \param source of the world, for people: a file or a demo
[[nodiscard]] core::Status focusOnEntity(
    scene::World& world, ecs::Entity camera, const ShotOptions& options, const std::string& source
);

/// The shot's view of the frame at `seconds`.
[[nodiscard]] extract::ViewRequest
makeView(const Shot& shot, const ShotOptions& options, double seconds);

/// The exposure of the frame at a time of the scene.
/// \param shutter of the camera; that of the flythrough changes it where no option sets one
[[nodiscard]] scene::ExposureInterval
computeExposure(const ShotOptions& options, scene::CameraShutter shutter, double seconds);

/// Sets frameTimes and firstFrame: frames `first` to `last`, both included, at `options.fps` of the
/// film.
/// Error: names `option`; there are too many frames, or they lie beyond the times that count.
[[nodiscard]] core::Status
planFrames(const char* option, double first, double last, ShotOptions& options);

/// Plans every frame whose time, in seconds, lies in the flight, both ends included; at least one.
[[nodiscard]] core::Status planWholeFlight(double from, double to, ShotOptions& options);

/// The camera that the clip `options.flythroughClip` moves: --camera's, or the first; of several
/// clips of the name, the first that moves one. Other clips that drive this camera or its parents
/// no longer play. Error: there is no such clip or camera.
[[nodiscard]] core::Result<ecs::Entity>
chooseClipCamera(scene::World& world, const ShotOptions& options);

/// Plans the frames of the whole clip, unless --frames did.
[[nodiscard]] core::Status planClipFrames(const scene::World& world, ShotOptions& options);

} // namespace shutter::game
