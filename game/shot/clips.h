// SPDX-License-Identifier: MIT
// Clips of a scene by name or index, and which of them play.
#pragma once

#include "engine/core/result.h"
#include "engine/scene/world.h"
#include "game/shot/shot_options.h"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace shutter::game {

/// "0 'Idle'", "2 without a name".
[[nodiscard]] std::string describeClip(const scene::World& world, uint32_t clip);
/// All, as describeClip() has them; "it has none".
[[nodiscard]] std::string listClips(const scene::World& world);

/// All clips of that name, in order; where there are none, the one of that index. Empty: none.
[[nodiscard]] std::vector<uint32_t> findClips(const scene::World& world, std::string_view wanted);

/// Activates the clips that --clip names. Without it, all play except those that drive a property
/// which a later playing clip drives, including morph weights: no clip plays in part. A warning
/// names them. \param flying a clip that plays before all others Error: --clip names none of the
/// clips.
[[nodiscard]] core::Status selectClips(
    scene::World& world, const ShotOptions& options, std::optional<uint32_t> flying = std::nullopt
);

/// One sentence about the clips that do not play unless they are chosen; empty: all do.
[[nodiscard]] std::string describeRestingClips(const scene::World& world);

} // namespace shutter::game
