// SPDX-License-Identifier: MIT
// The parts of an exposure: those within which nothing that is seen jumps, and as many equal ones
// as show bent ways straight. A raster image and motion vectors can show one way of each surface:
// what is in two places during an exposure, or in none for a while, takes a picture for each part,
// of which the frame's is the mean by light.
#pragma once

#include "engine/extract/extracted_frame.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace shutter::extract {

/// Most parts: where more jumps, the shortest are joined, and are taken as straight motion.
inline constexpr size_t kMaxExposureParts = 8;

struct ExposurePart {
    scene::ExposureInterval exposure;
    double share = 1.0; ///< of the light of all parts
};

/// The last one is the part that holds the frame's raster instant, or is the nearest to it; the
/// others are in their order; a part with less than scene::kLeastLight is left out. Empty: nothing
/// jumps, and the exposure is one. What jumps by less than a quarter of a pixel, or where no one
/// sees it, does not count, nor does a light, nor the way of what has no past (history.h). A
/// camera's jump that is a cut leaves nothing that moves.
[[nodiscard]] std::vector<ExposurePart>
planExposureParts(const scene::World& world, const SceneLayout& layout, const ViewRequest& view);

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
