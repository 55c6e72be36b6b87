// SPDX-License-Identifier: MIT
// How far two pictures are apart. All take the first three channels (or those there are), compare
// values as they stand, clamped to [0, 1], and need equal sizes and channel counts (CHECKed).
// Two pictures without a pixel are equal.
#pragma once

#include "engine/image/image.h"

namespace shutter::image {

/// Peak signal-to-noise ratio in dB for a peak of 1: 10 log10(1 / mean squared error) over all
/// pixels and channels. Infinity for equal pictures. NaN in either picture counts as the largest
/// error, 1.
[[nodiscard]] double computePsnr(const Image& a, const Image& b);

/// Structural similarity, Wang et al. 2004: 11x11 Gaussian window of sigma 1.5, K1 = 0.01,
/// K2 = 0.03, L = 1, on luminance (Rec. 709; below three channels the first), mean over the pixels
/// whose whole window lies inside. Along an axis shorter than the window every pixel counts, with
/// the part of its window that lies inside, renormalised. A window that holds a NaN scores 0.
[[nodiscard]] double computeSsim(const Image& a, const Image& b);

/// Largest absolute difference of any channel (not clamped). NaN counts as infinity; infinity
/// equals itself.
[[nodiscard]] double computeMaxDifference(const Image& a, const Image& b);

} // namespace shutter::image
