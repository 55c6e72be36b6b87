// SPDX-License-Identifier: MIT
// Errors that are seen in time and in no single picture. Pictures are as a display shows them, of
// equal sizes and channel counts (CHECKed); the first three channels count.
#pragma once

#include "engine/image/image.h"

#include <span>

namespace shutter::bench {

/// A frame of a method and the truth of the same instant.
struct FramePair {
    const image::Image& picture;
    const image::Image& truth;
};

/// Mean |(picture - the one before) - (truth - the one before)| over pixels and channels, [0, 2]:
/// change that nothing in the scene accounts for. An error that stays as it is does not flicker.
/// NaN counts as the largest change.
[[nodiscard]] double computeFlicker(const FramePair& before, const FramePair& now);

/// The fine part of a picture's error: (e - the mean of its four neighbours) / 2, by pixel and
/// channel, without the outermost pixels. A checkerboard of amplitude a keeps it, whatever varies
/// linearly vanishes. NaN counts as 1.
[[nodiscard]] image::Image computeFineError(const image::Image& picture, const image::Image& truth);

/// Mean product of two fine errors, of successive frames: what of the noise's power stays at its
/// place on the screen. 0 for noise that is new in each frame, in the mean.
[[nodiscard]] double computeFixedPower(const image::Image& before, const image::Image& now);

/// Root of the mean of a film's powers, 0 where that is negative, as it is by chance.
[[nodiscard]] double computeFixedNoise(std::span<const double> powers);

/// PSNR in dB of a film's frames together, whose mean squared errors are averaged. Infinite for
/// equal films. \param psnr of each frame; not empty
[[nodiscard]] double computeFilmPsnr(std::span<const double> psnr);

} // namespace shutter::bench
