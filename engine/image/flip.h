// SPDX-License-Identifier: MIT
// FLIP, the difference between two pictures that a person sees, of display values and of linear
// light.
#pragma once

#include "engine/image/image.h"

#include <cstdint>
#include <numbers>

namespace shutter::image {

/// Viewing conditions of FLIP, the default of Andersson 2020: a display 0.7 m and 3840 pixels wide,
/// seen from 0.7 m. 67.02 pixels per degree.
inline constexpr double kFlipPixelsPerDegree = 0.7 * (3840.0 / 0.7) * std::numbers::pi / 180.0;

struct FlipResult {
    double mean = 0.0; ///< of the map, [0, 1]; 0 for pictures without a pixel
    Image errorMap;    ///< one channel, [0, 1]: 0 no difference seen, 1 the largest
};

/// FLIP, the difference that a person sees who alternates between two pictures on one display:
/// Andersson, Nilsson, Akenine-Moller, Oskarsson, Astrom, Fairchild, "FLIP: A Difference Evaluator
/// for Alternating Images", HPG 2020 (the LDR metric, with the separable filters used from
/// version 1.2 on). Takes both pictures as a display does: sRGB-encoded, three channels (below
/// three, the first as grey; alpha is not compared), clamped to [0, 1]; equal sizes and channel
/// counts are CHECKed. The error is symmetric; equal pictures have error 0 everywhere. An error
/// whose filters reach a NaN (10 pixels each way) in either picture is 1.
[[nodiscard]] FlipResult computeFlip(const Image& a, const Image& b);

/// Exposures at which HDR-FLIP compares two pictures, in stops, evenly spaced.
struct ExposureRange {
    double first = 0.0; ///< shows the brightest light of the truth
    double last = 0.0;  ///< shows its median, or 20 stops above the first
    uint32_t count = 2; ///< about one per stop
};

/// \param truth linear light, three channels or more; values that are not finite do not count
[[nodiscard]] ExposureRange findHdrFlipExposures(const Image& truth);

/// HDR-FLIP: at each pixel the largest FLIP over exposures, since the exposure of the display is
/// unknown: Andersson, Nilsson, Shirley, Akenine-Moller, "Visualizing Errors in Rendered High
/// Dynamic Range Images", Eurographics 2021, with the tone map and exposures that the authors' tool
/// chooses. Light below 0 counts as 0. Equal sizes and channel counts, three at least, are CHECKed.
/// \param a, truth linear light
[[nodiscard]] FlipResult computeHdrFlip(const Image& a, const Image& truth);

} // namespace shutter::image
