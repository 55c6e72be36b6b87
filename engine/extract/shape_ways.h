// SPDX-License-Identifier: MIT
// Motion of deforming entities of a raster over the exposure: the data, besides the shapes, from
// which the device draws it.
#pragma once

#include "engine/extract/deformed_entity.h"
#include "engine/extract/extracted_frame.h"
#include "engine/extract/raster_record.h"
#include "engine/math/math.h"
#include "shaders/render/shape_ways_shared.h"

#include <array>
#include <cstdint>

namespace shutter::extract {

/// One deforming entity of one raster.
struct ShapeWay {
    uint32_t row = 0;   ///< of the raster's entity table
    uint32_t shape = 0; ///< index into ExtractedFrame::deformed of the frame whose exposure it is
    uint32_t mesh = 0;  ///< index into Assets::meshes
    /// Index of its pose at the raster: into ExtractedFrame::deformed of the raster's frame, or
    /// into RasterRecord::shapes.
    uint32_t pose = 0;
    shader::ShapeWayRow maps{};
};

/// Picture spaces (layer_tables.h) from the world at shutter open, halfway and close.
using ExposurePictures = std::array<math::dmat4, 3>;

/// Where an object is at the same times.
using ExposurePlaces = std::array<math::dmat4, 3>;

/// \param clipFromObject as the raster was drawn
/// \param pictureFromObject when it was
[[nodiscard]] shader::ShapeWayRow makeShapeWayRow(
    const math::mat4& clipFromObject,
    const math::dmat4& pictureFromObject,
    const ExposurePictures& pictures,
    const ExposurePlaces& places,
    bool isPerspective
);

} // namespace shutter::extract
