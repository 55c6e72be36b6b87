// SPDX-License-Identifier: MIT
// Surfaces of one entity that lie behind one another, told apart by how differently they move within the
// exposure. The parallax of a surface is how far it moves relative to one infinitely far away; its bin is
// half a pixel of that, and from kEvenBins on a share of it.
#ifndef SHUTTER_PARALLAX_BINS_GLSL
#define SHUTTER_PARALLAX_BINS_GLSL

#include "common/shim.h"

#ifdef __cplusplus
#include <bit>
#endif

SHUTTER_SHADER_BEGIN

SHUTTER_CONST uint kParallaxBins = 64u;
SHUTTER_CONST float kBinsPerPixel = 2.0f;
SHUTTER_CONST float kEvenBins = 24.0f;
SHUTTER_CONST float kBinsPerOctave = 12.0f;

/// A range of depths: the upper 16 bits of the least one's float, and shifted by 16 how many more such
/// values belong to it. This one holds all.
SHUTTER_CONST uint kAnyRange = 0xFFFF0000u;
/// Upper 16 bits beyond those of infinity.
SHUTTER_CONST uint kEndOfDepths = 0x7F81u;

#ifdef __cplusplus
inline uint bitsOfDepth(float depth) { return std::bit_cast<uint>(depth); }
#else
uint bitsOfDepth(float depth) { return floatBitsToUint(depth); }
#endif

/// \param depth at least 0
SHUTTER_INLINE bool isWithin(float depth, uint range) {
    return (bitsOfDepth(depth) >> 16u) - (range & 0xFFFFu) <= range >> 16u;
}

/// \param parallaxPx at least 0, infinity included
SHUTTER_INLINE uint parallaxBin(float parallaxPx) {
    float bin = kBinsPerPixel * parallaxPx;
    if (bin > kEvenBins) bin = kEvenBins + kBinsPerOctave * log2(bin / kEvenBins);
    return uint(min(bin, float(kParallaxBins - 1u)));
}

/// Parallax that a bin begins at, pixels. \param bin a fraction is a place within it
SHUTTER_INLINE float parallaxOfBin(float bin) {
    float even = bin <= kEvenBins ? bin : kEvenBins * exp2((bin - kEvenBins) / kBinsPerOctave);
    return even / kBinsPerPixel;
}

/// Least and greatest depth whose parallax lies between two places among the bins. The first bin goes on to
/// no parallax at all, the last one to infinity.
/// \param perAlong LayerMotion::parallaxes; more than 0
SHUTTER_INLINE vec2 depthsOfBins(float from, float to, float perAlong, bool perspective) {
    const float kEnd = 3.0e38f;
    float least = from <= 0.0f ? 0.0f : parallaxOfBin(from) / perAlong;
    float greatest = to >= float(kParallaxBins) ? kEnd : parallaxOfBin(to) / perAlong;
    if (!perspective) return vec2(least, greatest);
    return vec2(greatest < kEnd ? 1.0f / greatest : 0.0f, least > 0.0f ? 1.0f / least : kEnd);
}

/// Range of the depths whose parallax lies in some bins, with half of the bin on either side.
/// \param low, high first and last bin; the ones next to them are empty
SHUTTER_INLINE uint rangeOfBins(uint low, uint high, float perAlong, bool perspective) {
    vec2 depths = depthsOfBins(float(low) - 0.5f, float(high) + 1.5f, perAlong, perspective);
    uint first = bitsOfDepth(depths.x) >> 16u;
    uint end = depths.y < 3.0e38f ? bitsOfDepth(depths.y) >> 16u : kEndOfDepths;
    return first | (max(end, first + 1u) - first - 1u) << 16u;
}

SHUTTER_SHADER_END

#endif
