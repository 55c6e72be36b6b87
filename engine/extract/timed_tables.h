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

struct TimedTables {
    std::vector<MotionKeys> rows;         ///< parallel to ExtractedFrame::entities
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
};

/// Keys of all that `frame` was extracted from. An entity that cannot be drawn at the raster
/// instant but can at another (as one scaled to nothing for a while) gets an extra row after the
/// others: no pixel of the raster image has its id, but rays may hit it. Error: the world has more
/// entities than the table can hold, or the shapes need more than kMaxDeformedBytes.
[[nodiscard]] core::Result<TimedTables> computeTimedTables(
    const scene::World& world,
    const SceneLayout& layout,
    const ViewRequest& request,
    ExtractedFrame& frame
);

} // namespace shutter::extract
