// SPDX-License-Identifier: MIT
// Casters that move: where they and what lights see of them are over the exposure. Pure, in world
// space.
#pragma once

#include "engine/extract/extracted_frame.h"
#include "engine/extract/frame_view.h"
#include "engine/math/math.h"
#include "modules/shadows/shadow_views.h"

#include <cstdint>
#include <span>
#include <vector>

namespace shutter::shadows {

/// Maximum number of parts of the exposure with separate layers.
inline constexpr uint32_t kMaxCasterParts = 8;

/// Something that moves and casts shadows.
struct ShadowCaster {
    uint32_t row = 0;      ///< of the entity table
    Sphere sphere;         ///< at the raster instant; for deforming casters, around all their
                           ///< shapes
    double seenSize = 0.0; ///< radius over distance from the camera
    /// The form whose unit ellipsoid is that of the caster's box, up to a factor
    /// (ShadowMover::shape).
    math::dmat3 shape{1.0};
    double thinness = 1.0; ///< smallest extent of the box over its largest, above 0
    bool deforms = false;  ///< during the exposure
};

/// \param bounds object space, raster instant
/// \param eye of the camera
[[nodiscard]] ShadowCaster makeShadowCaster(
    const extract::ExtractedFrame& frame,
    const extract::SceneLayout& layout,
    uint32_t row,
    const math::dvec3& eye
);

/// A caster at one instant of the exposure.
struct CasterInstant {
    /// Takes points to where they are as seen from the caster at the raster instant.
    math::dmat4 rasterFromInstant{1.0};
    float shapeShift = 0.0f; ///< shader::ShadowDraw's
};

/// A caster over the exposure; no instants where it is static.
struct CasterPath {
    std::vector<CasterInstant> instants; ///< of equal shares of the light
    Sphere swept;                        ///< around the caster at all of them
};

/// \param count of instants, above 0
[[nodiscard]] CasterPath followCaster(
    const ShadowCaster& caster,
    const extract::FrameView& view,
    const extract::ExtractedFrame& frame,
    uint32_t count
);

/// A light in casters' space: the direction to it (w 0, unit) or its place (w 1).
using LightPlace = math::dvec4;

/// The same as a caster sees it that moved.
[[nodiscard]] LightPlace seeLight(const math::dmat4& rasterFromInstant, const LightPlace& light);

/// Returns the number of parts of the exposure for which the caster's outline must be drawn
/// separately, because it turns relative to a light or deforms: 0, or 2 to kMaxCasterParts and at
/// most the number of instants.
[[nodiscard]] uint32_t
countParts(const ShadowCaster& caster, const CasterPath& path, std::span<const LightPlace> lights);

} // namespace shutter::shadows
