// SPDX-License-Identifier: MIT
// An exposure in parts within which nothing that is seen jumps. A raster image and motion vectors
// can show one way of each surface: what is in two places during an exposure, or in none for a
// while, takes a picture for each part, of which the frame's is the mean by light.
#pragma once

#include "engine/extract/extracted_frame.h"

#include <cstddef>
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

} // namespace shutter::extract
