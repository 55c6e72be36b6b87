// SPDX-License-Identifier: MIT
// What an effect whose picture shows the whole exposure and the overlays over that agree on.
#pragma once

#include "engine/graph/graph.h"
#include "shaders/common/instant_surfaces.glsl"

#include <cstdint>
#include <functional>

namespace shutter::render {

/// At how many instants of the exposure overlays may be drawn.
struct OverlayLimits {
    uint32_t instants = 15; ///< max
    /// Above 1: min, each with another sample position in the pixel, for a picture with
    /// anti-aliased edges.
    uint32_t leastInstants = 1;
    bool findsInstants = false; ///< the effect finds depths and colours of surfaces at instants
    uint64_t surfaceBytes = 0;  ///< most memory for them
    /// Each instant has a place of the camera's lens: that of the effect's samples.
    bool hasLens = false;
};

/// As many of the wanted instants as a buffer of that size holds; 0: not even one.
[[nodiscard]] uint32_t fitInstants(shader::InstantSurfaces wanted, uint64_t bytes);

/// Surfaces visible in the pixels of a rectangle at instants of the exposure.
struct OverlaySurfaces {
    shader::InstantSurfaces rectangle;
    graph::BufferHandle words; ///< the rectangle, and data for shaders/common/instant_surfaces.glsl
};

/// An overlay in one part of the exposure: sums over its instants, each with the weight of an
/// instant of the whole exposure. Images that begin with the rectangle.
struct OverlayPart {
    graph::ImageHandle color;   ///< RGBA16F: premultiplied
    graph::ImageHandle opacity; ///< RGBA16F: in red
    float share = 1.0f;         ///< of the exposure
};

/// Puts an overlay over a picture, part by part, each over its own background.
/// \param draw declares the draws of a part
/// \param words OverlaySurfaces'; invalid: the picture lies behind each part
using CompositeParts = std::function<graph::ImageHandle(
    graph::ImageHandle picture,
    const std::function<OverlayPart(uint32_t part)>& draw,
    const shader::InstantSurfaces& rectangle,
    graph::BufferHandle words
)>;

} // namespace shutter::render
