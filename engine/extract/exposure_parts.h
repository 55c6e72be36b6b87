// SPDX-License-Identifier: MIT
// Splits an exposure into parts: at jumps of visible surfaces, and into equal parts that are short
// enough for curved motion to be straight within each. A raster image and motion vectors hold one
// motion per surface. A surface that is in two places during an exposure, or hidden for a while,
// needs a picture per part; the frame is their mean, weighted by light.
#pragma once

#include "engine/extract/extracted_frame.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace shutter::extract {

/// Maximum number of parts. Beyond it the shortest are joined and treated as straight motion.
inline constexpr size_t kMaxExposureParts = 8;

struct ExposurePart {
    scene::ExposureInterval exposure;
    double share = 1.0; ///< of the light of all parts
};

/// The last one is the part that holds the frame's raster instant, or is the nearest to it; the
/// others are in order of time; parts with less than scene::kMinLight are left out. Empty:
/// nothing jumps, and the exposure is not split. Ignored are jumps of less than a quarter of a
/// pixel, jumps that are not visible, lights, and entities without a past (history.h). After a
/// camera cut nothing moves.
[[nodiscard]] std::vector<ExposurePart>
planExposureParts(const scene::World& world, const SceneLayout& layout, const ViewRequest& view);

/// Most parts of an exposure.
inline constexpr uint32_t kMaxMotionParts = 32;

struct MotionParts {
    /// Parts of equal length, a power of two; 0: nothing moves or deforms, neither does the camera.
    uint32_t count = 0;
    /// Longest motion of an entity at its distance from the camera, pixels, which may be outside of
    /// the picture: an estimate of how its effect on the picture moves. 0 unless
    /// ViewRequest::unseenMatters.
    double unseenPx = 0.0;
    /// A light moves that lights the picture.
    bool movesLight = false;
};

/// Chooses the count so that in each part the chord of every motion is at least 0.9 of its path.
/// Motion is sampled at 65 instants; changes between two of them are missed.
/// \param frame extracted from `world` with `view`
[[nodiscard]] MotionParts planMotionParts(
    const scene::World& world,
    const SceneLayout& layout,
    const ExtractedFrame& frame,
    const ViewRequest& view
);

} // namespace shutter::extract
