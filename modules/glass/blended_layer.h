// SPDX-License-Identifier: MIT
// Which blended surfaces leave the raster, because one picture cannot represent them over the
// exposure, and the plan for drawing them over the blurred picture at several instants.
#pragma once

#include "engine/extract/extracted_frame.h"
#include "engine/render/overlay_surfaces.h"
#include "engine/scene/exposure_motion.h"
#include "engine/scene/world.h"
#include "shaders/glass/blended_layer_shared.h"

#include <cstdint>
#include <span>
#include <vector>

namespace shutter::glass {

/// Pixels that a blended surface may move between two instants at which it is drawn.
inline constexpr double kLayerStepPx = 2.5;

/// Returns the rows of the entity table whose blended surfaces leave the raster, in rising order:
/// those that move or deform in the world; those whose screen box over the exposure overlaps a
/// mover's; static ones that a moving camera or its lens sees move against their background
/// (decals.h); and those that may lie in front of or behind such a surface, so that the drawing
/// order is preserved. Empty where the raster instant shows the blended surfaces correctly.
/// \param motion of the view's exposure
/// \param hasLens the layer is drawn from places of the camera's lens
[[nodiscard]] std::vector<uint32_t> findLayerRows(
    const scene::World& world,
    const extract::SceneLayout& layout,
    const extract::ViewRequest& view,
    const scene::ExposureMotion& motion,
    const extract::ExtractedFrame& frame,
    bool hasLens = false
);

struct LayerItem {
    extract::DrawItem draw;
    uint32_t firstPlace = 0; ///< in BlendedLayer::places: one per instant
};

/// How the layer of one frame is drawn.
struct BlendedLayer {
    math::uvec2 originPx{0}; ///< of the rectangle that the layer may touch
    math::uvec2 sizePx{0};   ///< 0: nothing of it is in the picture
    std::vector<shader::LayerInstant> instants;
    uint32_t partCount = 1; ///< of the exposure, each composited over its own background
    /// The surfaces in front of or behind the layer differ between the instants: depths per instant
    /// and colours per part are looked up (shaders/common/instant_surfaces.glsl). Otherwise the
    /// layer is tested against the raster's depth, and testFromRelWorld maps to the raster's
    /// picture.
    bool readsInstants = false;
    std::vector<LayerItem> items; ///< nearest first
    std::vector<shader::LayerPlace> places;
    double longestWayPx = 0.0; ///< of a corner of a box around a surface

    [[nodiscard]] bool empty() const { return items.empty() || sizePx.x == 0 || sizePx.y == 0; }

    [[nodiscard]] shader::InstantSurfaces surfaces() const {
        return {originPx, sizePx, static_cast<uint32_t>(instants.size()), partCount, 0, 0};
    }
};

/// \param taken rows that findLayerRows() found
/// \param view its jitter is that of the colours that the layer is drawn over
[[nodiscard]] BlendedLayer planBlendedLayer(
    const scene::World& world,
    const extract::SceneLayout& layout,
    const extract::ViewRequest& view,
    const scene::ExposureMotion& motion,
    const extract::ExtractedFrame& frame,
    std::span<const uint32_t> taken,
    const render::OverlayLimits& limits
);

} // namespace shutter::glass
