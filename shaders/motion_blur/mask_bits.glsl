// SPDX-License-Identifier: MIT
// A block's masked pixels as 64 bits, from which its threads compute their places in the list
// without synchronization.
#ifndef SHUTTER_MOTION_BLUR_MASK_BITS_GLSL
#define SHUTTER_MOTION_BLUR_MASK_BITS_GLSL

#include "motion_blur/motion_blur_shared.h"

SHUTTER_SHADER_BEGIN

// Bit x + 8 y of a block of 8 x 8 pixels; rows 0 to 3 are x, rows 4 to 7 are y, so that no quad of 2 x 2
// pixels lies in both words.

SHUTTER_CONST uint kOddColumns = 0xAAAAAAAAu;
SHUTTER_CONST uint kOddRows = 0xFF00FF00u;

/// The first masked pixel of each quad, as bits of one word.
SHUTTER_INLINE uint leadersOfQuads(uint masked) {
    uint besides = masked | ((masked & kOddColumns) >> 1u) | ((masked << 1u) & kOddColumns);
    return masked & ~((masked << 1u) & kOddColumns) & ~((besides << 8u) & kOddRows);
}

/// Pixels that the list gets for a block.
/// \param quads a quad shares the ray of its first masked pixel
SHUTTER_INLINE uvec2 listedBits(uvec2 masked, bool quads) {
    return quads ? uvec2(leadersOfQuads(masked.x), leadersOfQuads(masked.y)) : masked;
}

SHUTTER_INLINE uint countBits(uvec2 bits) { return uint(bitCount(bits.x) + bitCount(bits.y)); }

/// Bits before a thread's own.
/// \param thread x + 8 y, [0, 63]
SHUTTER_INLINE uint countBitsBefore(uvec2 bits, uint thread) {
    uint own = (1u << (thread & 31u)) - 1u;
    return thread < 32u ? uint(bitCount(bits.x & own))
                        : uint(bitCount(bits.x) + bitCount(bits.y & own));
}

SHUTTER_INLINE bool hasBit(uvec2 bits, uint thread) {
    uint word = thread < 32u ? bits.x : bits.y;
    return ((word >> (thread & 31u)) & 1u) != 0u;
}

/// Rows of a dispatch in which `count` entries begin, `perRow` in each.
SHUTTER_INLINE uint countRows(uint count, uint perRow) { return (count + perRow - 1u) / perRow; }

SHUTTER_SHADER_END

#endif
