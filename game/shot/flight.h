// SPDX-License-Identifier: MIT
// `--flythrough`: a camera and the frames of a whole flight through the scene, from a file
// (flythrough.schema.json) or from one of the scene's own clips (`clip:NAME`).
#pragma once

#include "engine/core/result.h"
#include "engine/ecs/entity.h"
#include "engine/scene/world.h"
#include "game/options/render_options.h"

namespace shutter::game {

/// Reads the file that `arguments.flythrough` names and plans its frames, unless --frames did; the
/// file's frame rate counts unless --fps was typed, and its shutters unless the exposure was.
/// Nothing where none is asked for, or a clip. Error: names the file and the field.
[[nodiscard]] core::Status loadFlythrough(const RenderArguments& arguments, RenderOptions& options);

/// The camera that the clip `options.flythroughClip` moves: --camera's, or the first. Other clips
/// that drive this camera or its parents no longer play. Error: there is no such clip or camera.
[[nodiscard]] core::Result<ecs::Entity>
chooseClipCamera(scene::World& world, const RenderOptions& options);

/// Plans the frames of the whole clip, unless --frames did.
[[nodiscard]] core::Status planClipFrames(const scene::World& world, RenderOptions& options);

} // namespace shutter::game
