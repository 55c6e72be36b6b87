// SPDX-License-Identifier: MIT
// What lights see: the views that shadow maps are drawn from. Pure.
#pragma once

#include "engine/math/bounds.h"
#include "engine/math/math.h"

#include <array>
#include <cstdint>
#include <vector>

namespace shutter::shadows {

/// A view of a light. Depth is reversed.
struct LightView {
    math::dmat4 clipFromWorld{1.0};
    double texelMetres = 0.0; ///< width of a texel of the map, metres: at clip w = 1
};

/// What of a camera decides where cascades lie.
struct CameraSlice {
    math::dvec3 eye{0.0};
    math::dvec3 forward{0.0, 0.0, -1.0}; ///< unit
    /// Distance of the picture's corner from its middle, metres: at distance 1 (perspective) or at
    /// any (orthographic).
    double cornerReach = 1.0;
    bool isPerspective = true;
    double near = 0.05; ///< metres along the view, above 0: nothing much is nearer
};

struct Sphere {
    math::dvec3 centre{0.0};
    double radius = 0.0;
};

/// Smallest sphere around the part of the view between two distances: turning the camera leaves its
/// radius as it is.
[[nodiscard]] Sphere boundSlice(const CameraSlice& camera, double from, double to);

/// Most cascades of a light.
inline constexpr uint32_t kMaxCascades = 4;

/// Rows: right, up and towards a light that is far away, unit. The views of such a light differ in
/// place and scale alone.
[[nodiscard]] math::dmat3 makeLightAxes(const math::dvec3& toLight);

/// Cascades of a directional light, finest first: squares across the light, each larger than the
/// one before; the last one, or an earlier one that is large enough, covers the whole scene. A
/// cascade does not move while the camera moves by less than an eighth of its width, and moves by
/// whole texels: edges of static shadows do not crawl, and maps can be cached.
/// \param toLight unit
/// \param scene box around all casters and receivers, world space, not empty
/// \param farthest distance from the camera, metres, above 0
[[nodiscard]] std::vector<LightView> fitCascades(
    const CameraSlice& camera,
    const math::dvec3& toLight,
    const math::Bounds& scene,
    double farthest,
    uint32_t sizePx
);

/// Widest cone that a spot's single map has, radians from its axis; wider ones have a cube's six.
inline constexpr double kWidestSpot = 1.1;

/// \param direction unit, the way the light travels
/// \param halfAngle of the cone, radians, up to kWidestSpot
/// \param near nearer casters are passed over, metres, above 0
[[nodiscard]] LightView fitSpot(
    const math::dvec3& position,
    const math::dvec3& direction,
    double halfAngle,
    double near,
    uint32_t sizePx
);

/// Six views, in the order of cubeFace() (shadow_filter.glsl), along the world's axes.
[[nodiscard]] std::array<LightView, 6>
fitCube(const math::dvec3& position, double near, uint32_t sizePx);

/// The view that holds just one sphere, of a light that is far away.
[[nodiscard]] LightView fitLayer(const math::dvec3& toLight, const Sphere& mover, uint32_t sizePx);

/// The same for a light at a place outside of the sphere.
[[nodiscard]] LightView
fitPointLayer(const math::dvec3& position, const Sphere& mover, uint32_t sizePx);

/// Whether fitPointLayer() can show the sphere: the light is far enough from it.
[[nodiscard]] bool fitsPointLayer(const math::dvec3& position, const Sphere& mover);

} // namespace shutter::shadows
