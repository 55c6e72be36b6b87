// SPDX-License-Identifier: MIT
// FLIP, the difference a person sees who alternates between two pictures on one display: Andersson,
// Nilsson, Akenine-Moller, Oskarsson, Astrom, Fairchild, "FLIP: A Difference Evaluator for
// Alternating Images", HPG 2020 (the LDR metric, with the separable filters of its version 1.2 on).
#pragma once

#include "engine/image/image.h"

#include <numbers>

namespace shutter::image {

/// How the pictures are looked at, the default of Andersson 2020: from 0.7 m, on a display 0.7 m
/// and 3840 pixels wide. 67.02 pixels per degree.
inline constexpr double kFlipPixelsPerDegree = 0.7 * (3840.0 / 0.7) * std::numbers::pi / 180.0;

struct FlipResult {
    double mean = 0.0; ///< of the map, [0, 1]; 0 for pictures without a pixel
    Image errorMap;    ///< one channel, [0, 1]: 0 no difference seen, 1 the largest
};

/// Both pictures as a display takes them: sRGB-encoded, three channels (below three, the first as
/// grey; alpha is not compared), clamped to [0, 1]; equal sizes and channel counts are CHECKed.
/// The error is symmetric; equal pictures have error 0 everywhere. An error whose filters reach a
/// NaN (10 pixels each way) in either picture is 1.
[[nodiscard]] FlipResult computeFlip(const Image& a, const Image& b);

} // namespace shutter::image
