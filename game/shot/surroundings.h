// SPDX-License-Identifier: MIT
// Image-based light of a world, in addition to its lights: an equirectangular picture, or a sky.
#pragma once

#include "engine/core/result.h"
#include "engine/scene/world.h"
#include "game/shot/shot_options.h"

#include <filesystem>
#include <string>

namespace shutter::game {

/// Gives the world a clear sky whose sun is its first directional light, at `seconds`; without one,
/// the sky of a sun above left, which itself casts no light.
/// \param turbidity [environment::kMinTurbidity, environment::kMaxTurbidity]
/// \param intensity factor of the sky's light relative to the sun's, [0, 1000]; 1: physical
void addSky(scene::World& world, double turbidity, double intensity, double seconds);

/// Gives the world what `options` name; does nothing where they name neither.
/// Error: names --environment, the file and why.
[[nodiscard]] core::Status addSurroundings(scene::World& world, const ShotOptions& options);

/// Hash of the contents of the file that --environment names; empty without one.
[[nodiscard]] core::Result<std::string> computeSurroundingsHash(const std::filesystem::path& file);

} // namespace shutter::game
