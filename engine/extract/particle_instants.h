// SPDX-License-Identifier: MIT
// Where particles need what lies behind and before them at instants of the exposure.
#pragma once

#include "engine/extract/blended_layer.h"
#include "engine/extract/particles.h"
#include "engine/extract/swept_scene.h"

#include <optional>

namespace shutter::extract {

/// The rectangle of the picture in which particles meet opaque surfaces that move in it, and the
/// instants at which those are looked up. Nothing: the raster's depth hides the particles as well,
/// or the method or the memory allows no better.
/// \param particles of an exposure
[[nodiscard]] std::optional<shader::InstantSurfaces> planParticleInstants(
    const SweptSource& source, const ParticleTables& particles, const LayerLimits& limits
);

} // namespace shutter::extract
