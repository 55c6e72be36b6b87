// SPDX-License-Identifier: MIT
// Where particles need the surfaces behind and in front of them at instants of the exposure.
#pragma once

#include "engine/extract/blended_layer.h"
#include "engine/extract/particles.h"
#include "engine/extract/swept_scene.h"

#include <optional>

namespace shutter::extract {

/// Returns the rectangle of the picture in which particles overlap moving opaque surfaces, and the
/// instants at which those are looked up. Nothing: the raster's depth suffices, or the method or
/// the memory does not allow the lookup.
/// \param particles of an exposure
[[nodiscard]] std::optional<shader::InstantSurfaces> planParticleInstants(
    const SweptSource& source, const ParticleTables& particles, const LayerLimits& limits
);

} // namespace shutter::extract
