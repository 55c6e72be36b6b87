// SPDX-License-Identifier: MIT
// Where receivers are looked up in the layers of a mover, for a light that is far away: affine
// maps, which over a few instants change linearly, so that a shader works them out once. Pure.
#pragma once

#include "engine/extract/shadow_casters.h"
#include "engine/extract/shadow_views.h"
#include "engine/math/math.h"
#include "shaders/render/shadow_shared.h"

#include <cstdint>
#include <span>
#include <vector>

namespace shutter::extract {

/// How far a run may take a point of its mover from where the instant has it, texels.
inline constexpr double kMostRunError = 0.25;

/// A layer of a mover for one light.
struct MoverLayer {
    /// The mover when it is drawn: CasterInstant's; the raster instant's is the identity.
    math::dmat4 rasterFromInstant{1.0};
    LightView view;
    uint32_t sizePx = 0; ///< width and height, the same of all layers of a mover
    uint32_t firstTexel = 0;
};

/// Takes points of the world to where they are looked up in a layer that was drawn along another
/// way to the light, all as the mover sees it: x and y in texels, and depth. Along the ray to the
/// light only the depth changes. \param toLight unit
[[nodiscard]] math::dmat4 mapToLayer(
    const ShadowCaster& caster,
    const math::dmat4& rasterFromInstant,
    const math::dvec3& toLight,
    const MoverLayer& layer
);

/// The most instants per run for which no run errs by more than kMostRunError and each layer is
/// still used. 0: the mover is static.
/// \param layers the raster instant's, then those of equal parts of the exposure
[[nodiscard]] uint32_t findRunInstants(
    const ShadowCaster& caster,
    const CasterPath& path,
    std::span<const MoverLayer> layers,
    const math::dvec3& toLight
);

/// \param runInstants 1, 2 or shader::kMaxRunInstants; 0: the raster instant's run alone
/// \param eye origin of the space that the runs take points of
[[nodiscard]] std::vector<shader::ShadowRun> makeRuns(
    const ShadowCaster& caster,
    const CasterPath& path,
    std::span<const MoverLayer> layers,
    const math::dvec3& toLight,
    uint32_t runInstants,
    const math::dvec3& eye
);

} // namespace shutter::extract
