// SPDX-License-Identifier: MIT
// How different two pictures are. Values are clamped to [0, 1] except where noted; sizes and
// channel counts must be equal (CHECKed). Pictures without a pixel are equal. PSNR, SSIM and the
// largest difference compare the first three channels (or those there are) unconverted.
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

/// The largest magnitude of a picture's finite values, 1 at least: the peak of values that no
/// display bounds, such as motion or light.
[[nodiscard]] double findPeak(const Image& reference);

/// As computePsnr(), but of all channels, of values as they are, and for a peak of
/// findPeak(reference). A NaN, or an infinity that is not the same in both, counts as an error of
/// the peak.
[[nodiscard]] double computeStoredPsnr(const Image& picture, const Image& reference);

/// As computeSsim(), but of values as they are, for L = findPeak(reference), and the mean over the
/// channels unless these are a colour. A window that holds a NaN, or an infinity that is not the
/// same in both, scores 0. \param isColor three channels are red, green and blue, of which the
/// luminance is compared
[[nodiscard]] double computeStoredSsim(const Image& picture, const Image& reference, bool isColor);

/// Largest absolute difference of any channel (not clamped). NaN counts as infinity; infinity
/// equals itself.
[[nodiscard]] double computeMaxDifference(const Image& a, const Image& b);

} // namespace shutter::image
