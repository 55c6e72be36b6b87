// SPDX-License-Identifier: MIT
// Finds what of a frame's motion CameraShutter::maxBlurPercent leaves (scene::MotionCap).
#pragma once

#include "engine/extract/extracted_frame.h"
#include "engine/image/image.h"
#include "engine/scene/exposure_motion.h"
#include "engine/scene/shutter.h"

namespace shutter::extract {

/// Lowers the shares of what moves farther than the cap.
/// \param frame extracted with `cap`
/// \param motion, entityId the frame's intermediates
/// \param uncapped motion of the same exposure without a cap: tells movers from the still world
/// \param maxPx the cap, 0 or more
/// \return true: something moved farther than the cap, by more than a hundredth
[[nodiscard]] bool tightenCap(
    scene::MotionCap& cap,
    const ExtractedFrame& frame,
    const image::Image& motion,
    const image::Image& entityId,
    const scene::ExposureMotion& uncapped,
    double maxPx
);

} // namespace shutter::extract
