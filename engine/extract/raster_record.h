// SPDX-License-Identifier: MIT
// Records the contents of a raster image, so that the next frame finds its surfaces.
#pragma once

#include "engine/ecs/entity.h"
#include "engine/extract/extracted_frame.h"
#include "engine/math/math.h"
#include "engine/scene/exposure_motion.h"
#include "engine/scene/history.h"
#include "engine/scene/world.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace shutter::extract {

/// Share of a frame's duration within which two times are the same: frame times are rounded.
inline constexpr double kFrameSlack = 1.0e-3;
/// The entity has no row.
inline constexpr uint32_t kNoRow = 0xFFFFFFFFu;

/// A skinned or morphed entity as a raster image was drawn of it.
struct RasterShape {
    uint32_t row = 0;  ///< of the entity table
    uint32_t mesh = 0; ///< index into Assets::meshes
    scene::Deformation pose;
    math::mat4 clipFromObject{1.0f}; ///< EntityRow::clipFromObjectRaster
};

/// The contents of a raster image: enough to find its surfaces in the next frame.
struct RasterRecord {
    double seconds = 0.0; ///< the frame's own time
    ecs::Entity camera;
    uint32_t width = 0;
    uint32_t height = 0;
    math::dmat4 pictureFromWorld{1.0};    ///< picture space (layer_tables.h)
    math::dmat4 unjitteredFromWorld{1.0}; ///< the same without the view's jitter
    std::vector<ecs::Entity> entities;    ///< one per row of the entity table
    std::vector<math::dmat4> worldFromObject;
    std::vector<bool> deforms;       ///< the row's shape changes during the exposure
    std::vector<RasterShape> shapes; ///< in the order of their rows: 128 bytes per joint
    /// Those whose blended surfaces are not in the raster, in order; set by the caller.
    std::vector<ecs::Entity> taken;
};

/// The rows' entities, in order.
[[nodiscard]] std::vector<ecs::Entity>
listEntities(const ExtractedFrame& frame, std::span<const uint32_t> rows);

/// Picture space (layer_tables.h) at shutter time `s` from the world, as ViewRequest::lensPlace has
/// it.
/// \param motion of the view's exposure
[[nodiscard]] math::dmat4 pictureFromWorldAt(
    const scene::World& world,
    const ViewRequest& view,
    const scene::ExposureMotion& motion,
    double s
);

/// \param motion of the view's exposure
/// \param s shutter time that the raster is taken at
[[nodiscard]] RasterRecord makeRasterRecord(
    const scene::World& world,
    const ViewRequest& view,
    const scene::ExposureMotion& motion,
    const ExtractedFrame& frame,
    double s
);

/// Whether the view shows what `last` does, from elsewhere or later: the same camera draws it in
/// the same size, and nothing was cut in between.
/// \param motion of the view's exposure
/// \param last not later than the view's raster
[[nodiscard]] bool showsTheSame(
    const scene::World& world,
    const ViewRequest& view,
    const scene::ExposureMotion& motion,
    const RasterRecord& last
);

/// Whether `last` was drawn exactly one frame before by the same view. A frame's result must not
/// depend on which frames were drawn before.
/// \param motion of the view's exposure
[[nodiscard]] bool isOfFrameBefore(
    const scene::World& world,
    const ViewRequest& view,
    const scene::ExposureMotion& motion,
    const RasterRecord& last
);

/// Whether the view's frame is the one that `last` was drawn for, which is drawn again, as while a
/// game is paused: of the same time, from the same place.
/// \param motion of the view's exposure
[[nodiscard]] bool isOfSameFrame(
    const scene::World& world,
    const ViewRequest& view,
    const scene::ExposureMotion& motion,
    const RasterRecord& last
);

/// The view of the previous frame, for a raster that isOfFrameBefore(); nothing where that frame
/// shows something else, or no time has passed since. \param motion of the view's exposure
[[nodiscard]] std::optional<ViewRequest> makeViewBefore(
    const scene::World& world, const ViewRequest& view, const scene::ExposureMotion& motion
);

/// The time since `last` in which events end a thing's past.
[[nodiscard]] scene::TimeSpan
spanSince(const RasterRecord& last, const scene::ExposureInterval& exposure);

/// By row of `record`: the same entity's row among `entities`, or kNoRow.
[[nodiscard]] std::vector<uint32_t>
findRows(const RasterRecord& record, const std::vector<ecs::Entity>& entities);

} // namespace shutter::extract
