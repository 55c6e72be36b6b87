// SPDX-License-Identifier: MIT
// Where the surfaces that this frame's raster holds were seen in the raster drawn before it, on the
// CPU. Exact for whatever moves rigidly, along any path, however long ago that was and whatever the
// exposure: for effects that reuse their last picture.
#pragma once

#include "engine/extract/extracted_frame.h"
#include "engine/extract/raster_record.h"
#include "engine/math/layer_tables.h"
#include "engine/scene/world.h"

#include <optional>

namespace shutter::extract {

/// How much older than the frame before a raster may be, in frames: what a picture of then shows is
/// soon gone.
inline constexpr double kMostFramesAgo = 4.0;

struct Reprojection {
    RasterRecord record; ///< of this frame's raster, for the frame after
    /// From this frame's picture space to the last one's, both without jitter: each mover has one
    /// map, InstantMotion::instantFromRaster. What has no past is shader::kNoMover; what deforms is
    /// shader::kDeformedMover. Nothing: the last raster says nothing about this frame.
    std::optional<math::LayerTables> last;
    double ageSeconds = 0.0; ///< of the last raster
    bool isPerspective = true;
};

/// \param motion of the view's exposure
/// \param last drawn before this frame, or null. It counts if the same camera drew it at most
/// kMostFramesAgo before, or at the same time, in the same size and without a cut in between
[[nodiscard]] Reprojection computeReprojection(
    const scene::World& world,
    const ViewRequest& view,
    const scene::ExposureMotion& motion,
    const ExtractedFrame& frame,
    const RasterRecord* last
);

} // namespace shutter::extract
