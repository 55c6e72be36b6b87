// SPDX-License-Identifier: MIT
// How far a lens spreads what a picture may show, by the bounds of what is drawn.
#pragma once

#include "engine/extract/extracted_frame.h"
#include "engine/scene/exposure_motion.h"

namespace shutter::extract {

/// Circles of confusion up to this diameter are indistinguishable from none, pixels.
inline constexpr double kMinDefocusPx = 0.5;

/// Whether the lens may spread something in the picture over more than kMinDefocusPx: what lies
/// in the bounds of an entity that is drawn, where these are in sight, or infinitely far away.
/// False without ViewRequest::usesLens. Bounds that hold the camera count as touching it: any open
/// lens spreads them. \param motion of the view's exposure
[[nodiscard]] bool isDefocused(
    const scene::World& world,
    const ViewRequest& view,
    const scene::ExposureMotion& motion,
    const ExtractedFrame& frame,
    const SceneLayout& layout
);

} // namespace shutter::extract
