// SPDX-License-Identifier: MIT
// All motion of a frame as keys, on the CPU: entities, camera, lights.
#pragma once

#include "engine/core/result.h"
#include "engine/extract/deformation_keys.h"
#include "engine/extract/extracted_frame.h"
#include "engine/extract/motion_keys.h"
#include "engine/extract/spatial_order.h"

#include <cstdint>
#include <vector>

namespace shutter::extract {

/// Most intervals between two tables of lights.
inline constexpr uint32_t kMaxLightIntervals = 256;

/// Most memory that the shapes of a frame may take on the device, bytes.
inline constexpr uint64_t kMaxDeformedBytes = uint64_t{1} << 30;

/// A deformed mesh over the exposure.
struct TimedDeformation {
    uint32_t row = 0;
    uint32_t mesh = 0;
    std::vector<scene::Deformation> keys; ///< as DeformationKeys::keys
    math::Bounds bounds;                  ///< object space, over the whole exposure
    bool mirrored = false;                ///< the joints turn the winding round

    [[nodiscard]] bool changes() const { return keys.size() > 1; }
};

/// A row of the entity table behind those of the frame.
struct ExtraRow {
    shader::EntityRow row;
    uint32_t mesh = 0; ///< index into Assets::meshes
};

struct TimedTables {
    std::vector<MotionKeys> rows; ///< parallel to ExtractedFrame::entities, then to `extra`
    /// Entities that cannot be drawn at the raster instant but can at another: no pixel of the
    /// raster image has their id.
    std::vector<ExtraRow> extra;
    std::vector<TimedDeformation> shapes; ///< of the rows whose mesh is deformed, in their order
    MotionKeys camera;     ///< relWorldFromView, widened by the lens as TimedConstants::cameraKeys
    math::vec4 view{0.0f}; ///< TimedConstants::view
    std::vector<shader::LensKey> lens;    ///< TimedConstants::lensKeys; empty: a pinhole
    math::vec4 aperture{0.0f};            ///< TimedConstants::aperture
    math::vec2 jitterPx{0.0f};            ///< of the picture: TimedConstants::jitterPx
    std::vector<shader::LightRow> lights; ///< all lights at the first key, then at the next, ...
    uint32_t lightKeyCount = 1;
    std::vector<uint32_t> moving; ///< rows that move and can be hit, in spatial order
    std::vector<Box> boxes; ///< of `moving`: camera-relative space, over the whole exposure, finite

    /// A row of `frame`, which the tables were computed of, or of `extra`.
    [[nodiscard]] ExtraRow findRow(const ExtractedFrame& frame, size_t row) const {
        const size_t own = frame.entities.size();
        if (row < own)
            return {frame.entities[row], frame.entityMeshes[row]};
        return extra.at(row - own);
    }
};

/// Keys of all that `frame` was extracted from. An entity that cannot be drawn at the raster
/// instant but can at another (as one scaled to nothing for a while) gets an extra row, since rays
/// may hit it. Error: the world has more entities than the table can hold, or the shapes need more
/// than kMaxDeformedBytes.
[[nodiscard]] core::Result<TimedTables> computeTimedTables(
    const scene::World& world,
    const SceneLayout& layout,
    const ViewRequest& request,
    const ExtractedFrame& frame
);

} // namespace shutter::extract
