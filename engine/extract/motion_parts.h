// SPDX-License-Identifier: MIT
// In how many parts an exposure's motion is straight enough to be measured by where each part
// begins and ends: a wheel that turns once is where it was, yet its rim went a long way.
#pragma once

#include "engine/extract/extracted_frame.h"

#include <cstdint>

namespace shutter::extract {

/// Most parts of an exposure.
inline constexpr uint32_t kMaxMotionParts = 32;

struct MotionParts {
    /// Parts of equal length, a power of two; 0: nothing moves or deforms, neither does the camera.
    uint32_t count = 0;
    /// Longest way of a caster of shadows at its distance from the camera, pixels: what a shadow
    /// may move, whose caster need not be in the picture. 0 without shadows.
    double casterPx = 0.0;
    /// A light moves that lights the picture.
    bool movesLight = false;
};

/// Each part's chord is at least 0.9 of the way, for all that moves at all. Motion is looked at at
/// 65 instants; what comes and goes between two of them is not seen.
/// \param frame extracted from `world` with `view`
[[nodiscard]] MotionParts planMotionParts(
    const scene::World& world,
    const SceneLayout& layout,
    const ExtractedFrame& frame,
    const ViewRequest& view
);

} // namespace shutter::extract
