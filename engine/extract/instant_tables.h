// SPDX-License-Identifier: MIT
// Where the surfaces that a raster image holds are seen at other instants of the exposure, on the
// CPU: of this frame's rasters and of the last one's. Exact for rigid motion along any path and for
// any camera; for deforming entities it holds the data for drawing their motion.
#pragma once

#include "engine/extract/extracted_frame.h"
#include "engine/extract/raster_record.h"
#include "engine/extract/shape_ways.h"
#include "engine/math/layer_tables.h"
#include "engine/math/math.h"
#include "engine/scene/world.h"

#include <cstdint>
#include <vector>

namespace shutter::extract {

struct InstantTables : math::InstantLayers {
    RasterRecord record; ///< of this frame's raster, for the frame after
    // Deforming entities (shader::kDeformedMover), by layer.
    std::vector<ShapeWay> rasterWays;
    std::vector<ShapeWay> secondWays;
    std::vector<ShapeWay> lastWays;
    /// By index into ExtractedFrame::deformed: the shape halfway through the exposure. Empty if not
    /// needed; also for shapes that do not change.
    std::vector<scene::Deformation> middles;
};

/// Another raster of the frame, of another instant of its exposure.
struct InstantFrame {
    double instant = 0.0; ///< shutter time, [0, 1]
    const ExtractedFrame& frame;
    math::dvec2 jitterPx{0.0}; ///< of its picture
};

/// Computes the tables. Instants are the middles of equal shares of the light, by the shutter's
/// response.
/// \param view its jitter is that of the layers' colours: none if an effect has removed the
/// raster's
/// \param motion of the view's exposure
/// \param instantCount above 0; with ViewRequest::usesLens spreadLensPairs() has as many pairs, in
/// that order
/// \param last of the frame drawn before, or null. used only if that was one frame ago, by the same
/// camera, in the same size and without a cut in between, and not for entities that appeared, were
/// teleported or changed their mesh
/// \param second drawn for the same view, or null
/// \param taken RasterRecord::taken of the frame
[[nodiscard]] InstantTables computeInstantTables(
    const scene::World& world,
    const ViewRequest& view,
    const scene::ExposureMotion& motion,
    const ExtractedFrame& frame,
    uint32_t instantCount,
    const RasterRecord* last,
    const InstantFrame* second = nullptr,
    std::vector<ecs::Entity> taken = {}
);

} // namespace shutter::extract
