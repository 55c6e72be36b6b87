// SPDX-License-Identifier: MIT
// Pictures and cameras as a frame that a host of the motion blur would give.
#pragma once

#include "engine/core/result.h"
#include "game/blur/cameras.h"
#include "game/blur/passes.h"
#include "game/replay/dump_reader.h"
#include "modules/motion_blur/methods.h"

#include <string>

namespace shutter::blur {

/// When the shutter is open.
struct PictureShutter {
    double exposureShare = 0.5; ///< of the time between two frames, above 0 and at most 16
    double rasterTime = 1.0;    ///< of the pictures in the exposure: 0 open, 1 close
};

/// Error: what the method needs and pictures do not hold, or hold with an option.
[[nodiscard]] core::Status
checkMethod(const motion_blur::Method* method, const char* name, bool hasCameras);

/// \param cameras null: none
/// \param followsLast the view's last frame was the one before
/// Error: the cameras lack what the method needs.
[[nodiscard]] core::Result<replay::DumpFrame> makeFrame(
    const Passes& passes,
    const Cameras* cameras,
    const PictureShutter& shutter,
    const motion_blur::MotionBlurSettings& settings,
    int number,
    bool followsLast
);

/// Alpha as the frame's colour, to blur it as well.
void showAlpha(replay::DumpFrame& frame, const Passes& passes);

} // namespace shutter::blur
