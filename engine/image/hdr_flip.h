// SPDX-License-Identifier: MIT
#pragma once

#include "engine/image/image.h"
#include "engine/image/metrics.h"

#include <cstdint>

namespace shutter::image {

/// Exposures at which HDR-FLIP looks at two pictures, in stops, evenly apart.
struct ExposureRange {
    double first = 0.0; ///< shows the brightest light of the truth
    double last = 0.0;  ///< shows its median, or 20 stops above the first
    uint32_t count = 2; ///< about one a stop
};

/// \param truth linear light, three channels or more; values that are not finite do not count
[[nodiscard]] ExposureRange findHdrFlipExposures(const Image& truth);

/// HDR-FLIP: at each pixel the largest FLIP over exposures, since nobody knows at which one a
/// picture will be shown: Andersson, Nilsson, Shirley, Akenine-Moller, "Visualizing Errors in
/// Rendered High Dynamic Range Images", Eurographics 2021, with the tone map and exposures that the
/// authors' tool chooses. Light below 0 counts as 0. Equal sizes and channel counts, three at
/// least, are CHECKed. \param a, truth linear light
[[nodiscard]] FlipResult computeHdrFlip(const Image& a, const Image& truth);

} // namespace shutter::image
