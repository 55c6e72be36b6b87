// SPDX-License-Identifier: MIT
// The lens of a camera in the tables of motion: how its places displace what a picture shows.
#pragma once

#include "engine/math/layer_tables.h"
#include "engine/math/math.h"
#include "shaders/common/aperture.glsl"

#include <cstdint>
#include <span>

namespace shutter::math {

/// A perspective camera's lens at one time, and the picture that it draws.
struct ThinLens {
    dvec2 pixelsPerUnit{1.0};    ///< measurePixelsPerUnit() of the camera
    double radius = 0.0;         ///< half the opening's height, metres
    double focusDistance = 10.0; ///< along the axis, metres, above 0
    shader::Aperture aperture{}; ///< shape of the opening
};

/// Returns how many pixels right and down of the axis a picture shows a point of x/z and y/z 1.
/// \param clipFromView perspective with a clip w of -z
[[nodiscard]] dvec2 measurePixelsPerUnit(const dmat4& clipFromView, const uvec2& sizePx);

/// Returns InstantMotions::confusion of a raster that the camera draws.
[[nodiscard]] vec2 confusionOf(const ThinLens& lens);

/// Gives each sample of the exposure its places of the lens (spreadLensPairs()): fills the lens's
/// fields, repeats `times`, and marks no layer as static, since other places of the lens see
/// elsewhere what a pinhole sees at rest.
/// \param lenses one per sample, as layers.times is; at least one
/// \param raster at the raster instant
/// \param turn as for spreadLensPairs()
void addLens(
    std::span<const ThinLens> lenses, const ThinLens& raster, uint32_t turn, InstantLayers& layers
);

} // namespace shutter::math
