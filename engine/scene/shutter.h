// SPDX-License-Identifier: MIT
// When a frame's light is taken: the shutter's pure functions.
#pragma once

#include "engine/core/result.h"
#include "engine/scene/components.h"
#include "engine/scene/motion_cap.h"
#include "shaders/common/shutter_response_shared.h"

#include <cmath>
#include <optional>

namespace shutter::scene {

/// Duration of a frame that stands alone.
inline constexpr double kStillFrameSeconds = 1.0 / 24.0;

/// The exposure around a frame's own time, and the shutter it is one of.
struct ExposureInterval {
    double open = 0.0;   ///< seconds
    double raster = 0.0; ///< seconds: when the raster image is taken
    double close = 0.0;  ///< seconds

    [[nodiscard]] double at(double s) const { return std::lerp(open, close, s); } ///< s in [0, 1]

    /// s of the raster instant: 0 start, 0.5 centre, 1 end.
    double rasterTime = 1.0;
    double frameSeconds = 0.0; ///< since the frame before, 0 or more
    CameraShutter shutter{};
    MotionCap cap{}; ///< of this frame; render::measureMotionCap() finds it
};

/// Length of the exposure, 0 or more and finite. A frame of duration 0 is a paused one: nothing
/// moves, whatever the mode, and the exposure is 0. What is negative or not finite counts as 0,
/// except that Capped takes a frame of any length.
[[nodiscard]] double computeExposureSeconds(const CameraShutter& shutter, double frameSeconds);

/// \param raster the frame's own time, seconds
/// \param frameSeconds the frame's duration
[[nodiscard]] ExposureInterval computeExposure(
    const CameraShutter& shutter, double raster, double frameSeconds = kStillFrameSeconds
);

/// One sentence that names the field which is out of its range.
[[nodiscard]] core::Status validateResponse(const ShutterResponse& response);

/// The response as methods sample it; nothing for one that is constant, as a box is. Must be valid
/// (CHECKed).
[[nodiscard]] std::optional<shader::ResponseTable>
computeResponseTable(const ShutterResponse& response);

/// Shutter time before which the share u of the light is taken; a box leaves u as it is.
[[nodiscard]] double invertResponse(const ShutterResponse& response, double u);

} // namespace shutter::scene
