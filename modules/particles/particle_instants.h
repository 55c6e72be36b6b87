// SPDX-License-Identifier: MIT
// Where particles need the surfaces behind and in front of them at instants of the exposure.
#pragma once

#include "engine/extract/swept_scene.h"
#include "engine/render/overlay_surfaces.h"
#include "modules/particles/particle_tables.h"

#include <optional>

namespace shutter::particles {

/// Returns the rectangle of the picture in which particles overlap moving opaque surfaces, and the
/// instants at which those are looked up. Nothing: the raster's depth suffices, or the method or
/// the memory does not allow the lookup.
/// \param particles of an exposure
[[nodiscard]] std::optional<shader::InstantSurfaces> planParticleInstants(
    const extract::SweptSource& source,
    const ParticleTables& particles,
    const render::OverlayLimits& limits
);

} // namespace shutter::particles
