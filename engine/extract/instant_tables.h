// SPDX-License-Identifier: MIT
// Where the surfaces that a raster image holds are seen at other instants of the exposure, on the
// CPU: of this frame's rasters and of the last one's. Exact for whatever moves rigidly, along any
// path and before any camera; what deforms is left to motion vectors.
#pragma once

#include "engine/ecs/entity.h"
#include "engine/extract/extracted_frame.h"
#include "engine/math/layer_tables.h"
#include "engine/math/math.h"
#include "engine/scene/world.h"

#include <cstdint>
#include <vector>

namespace shutter::extract {

/// What a raster image was drawn of: enough to find its surfaces again in the frame after.
struct RasterRecord {
    double seconds = 0.0;
    ecs::Entity camera;
    uint32_t width = 0;
    uint32_t height = 0;
    math::dmat4 pictureFromWorld{1.0}; ///< picture space (layer_tables.h)
    std::vector<ecs::Entity> entities; ///< one per row of the entity table
    std::vector<math::dmat4> worldFromObject;
    std::vector<bool> deforms; ///< the row's shape changes during the exposure
};

struct InstantTables : math::InstantLayers {
    RasterRecord record; ///< of this frame's raster, for the frame after
};

/// Another raster of the frame, of another instant of its exposure.
struct InstantFrame {
    double instant = 0.0; ///< shutter time, [0, 1]
    const ExtractedFrame& frame;
};

/// Instants are the middles of equal shares of the light, by the shutter's response.
/// \param instantCount above 0
/// \param last of the frame drawn before, or null. It counts only if that was one frame ago, by the
/// same camera, in the same size and without a cut in between; of what has appeared, was teleported
/// or deforms, nothing counts
/// \param second drawn for the same view, or null; nothing of it that deforms counts
[[nodiscard]] InstantTables computeInstantTables(
    const scene::World& world,
    const ViewRequest& view,
    const ExtractedFrame& frame,
    uint32_t instantCount,
    const RasterRecord* last,
    const InstantFrame* second = nullptr
);

} // namespace shutter::extract
