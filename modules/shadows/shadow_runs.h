// SPDX-License-Identifier: MIT
// Mapping of receivers into the layers of a mover, for a directional light: affine maps that change
// linearly over a few instants, so that a shader computes them once. Pure functions.
#pragma once

#include "engine/math/math.h"
#include "modules/shadows/shadow_casters.h"
#include "modules/shadows/shadow_views.h"
#include "shaders/shadows/shadow_shared.h"

#include <cstdint>
#include <span>
#include <vector>

namespace shutter::shadows {

/// How far a run may take a point of its mover from where the instant has it, texels.
inline constexpr double kMaxRunError = 0.25;

/// A layer of a mover for one light.
struct MoverLayer {
    /// The mover when it is drawn: CasterInstant's; the raster instant's is the identity.
    math::dmat4 rasterFromInstant{1.0};
    LightView view;
    uint32_t sizePx = 0; ///< width and height, the same of all layers of a mover
    uint32_t firstTexel = 0;
};

/// Maps world points to texels x and y and to depth in a layer that was drawn for another direction
/// to the light, in the mover's space. Along the ray to the light only the depth changes. \param
/// toLight unit
[[nodiscard]] math::dmat4 mapToLayer(
    const ShadowCaster& caster,
    const math::dmat4& rasterFromInstant,
    const math::dvec3& toLight,
    const MoverLayer& layer
);

/// The most instants per run for which no run errs by more than kMaxRunError and each layer is
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
[[nodiscard]] std::vector<shader::CasterSpan> makeRuns(
    const ShadowCaster& caster,
    const CasterPath& path,
    std::span<const MoverLayer> layers,
    const math::dvec3& toLight,
    uint32_t runInstants,
    const math::dvec3& eye
);

} // namespace shutter::shadows
