// SPDX-License-Identifier: MIT
// Taps as bits of a word: one bit per tap up to 32 of them, else one for several in a row.
#ifndef SHUTTER_MOTION_BLUR_MISSING_TAPS_GLSL
#define SHUTTER_MOTION_BLUR_MISSING_TAPS_GLSL

#include "common/shim.h"

SHUTTER_SHADER_BEGIN

SHUTTER_INLINE uint tapsPerBit(uint tapCount) { return (tapCount + 31u) / 32u; }

SHUTTER_INLINE uint bitOfTap(uint tap, uint tapCount) { return tap / tapsPerBit(tapCount); }

/// The middle one of a bit's taps.
SHUTTER_INLINE uint tapOfBit(uint bit, uint tapCount) {
    uint perBit = tapsPerBit(tapCount);
    return min(bit * perBit + perBit / 2u, tapCount - 1u);
}

SHUTTER_SHADER_END

#endif
