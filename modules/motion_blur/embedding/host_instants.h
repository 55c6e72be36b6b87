// SPDX-License-Identifier: MIT
// Tables of a frame's instants from a host's description of motion.
#pragma once

#include "engine/core/result.h"
#include "engine/math/layer_tables.h"
#include "engine/math/math.h"
#include "modules/motion_blur/embedding/host_motion.h"

#include <cstdint>
#include <vector>

namespace shutter::motion_blur {

/// Inputs of a frame's motion besides HostMotion itself.
struct HostMotionFrame {
    math::uvec2 sizePx{1u};
    double rasterTime = 1.0;        ///< HostInputs::rasterTime
    bool hasResponse = false;       ///< HostInputs::response is not 0
    uint32_t instantCount = 1;      ///< countInstants() (settings.h); with a lens, of samples
    bool knowsLastDeformed = false; ///< HostInputs::lastDeformedMotion is given
};

/// Shutter time by which a share of the exposure's light is taken. \param table null: a box
[[nodiscard]] double invertResponse(const shader::ResponseTable* table, double u);

/// Whether a key is the raster instant's.
[[nodiscard]] bool isRasterKey(const HostCameraKey& key, double rasterTime);

/// One sentence that names the field which is wrong.
[[nodiscard]] core::Status checkMotion(const HostMotion& motion, const HostMotionFrame& frame);

/// The contents of a raster: enough to find its surfaces in the next frame.
struct HostRaster {
    /// A row that HostMotion::movers had.
    struct Mover {
        uint32_t row = 0;
        bool deforms = false;
        math::dmat4 worldFromObject{1.0}; ///< at the raster instant
    };

    math::uvec2 sizePx{0u};
    bool isPerspective = true;
    math::dmat4 pictureFromWorld{1.0}; ///< picture space (layer_tables.h)
    uint32_t rowCount = 0;
    bool hasViewModel = false; ///< it has one more row, HostMotion::hasViewModel's
    std::vector<Mover> movers;
    std::vector<uint64_t> rowIds; ///< empty: the row is the id
};

struct HostInstants {
    math::InstantLayers layers;
    HostRaster raster; ///< this frame's, for the frame after
};

/// \param motion as checkMotion() accepts it
/// \param last of the previous frame, or null. It counts only in the same size and kind of
/// projection
[[nodiscard]] HostInstants
computeHostInstants(const HostMotion& motion, const HostMotionFrame& frame, const HostRaster* last);

} // namespace shutter::motion_blur
