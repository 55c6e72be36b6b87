// SPDX-License-Identifier: MIT
// Classes of tile neighbourhoods and of blocks of pixels, by the filter that they need.
#ifndef SHUTTER_MOTION_BLUR_BLOCK_CLASS_GLSL
#define SHUTTER_MOTION_BLUR_BLOCK_CLASS_GLSL

#include "common/numeric.glsl"
#include "motion_blur/motion_blur_shared.h"

SHUTTER_SHADER_BEGIN

// In order of cost; stored as floats, which every sampler can read.
SHUTTER_CONST float kClassStill = 0.0f;   // nothing within reach moves
SHUTTER_CONST float kClassUniform = 1.0f; // all within reach moves by the dominant motion
SHUTTER_CONST float kClassMixed = 2.0f;   // anything else, at depths too alike to hide anything
SHUTTER_CONST float kClassDeep = 3.0f;    // the same, and a deeper surface may become visible

/// Deviation from the dominant motion within which motion is uniform, pixels. With a deviation e
/// the weight of a tap at u of the motion v is off by at most u e / v of the cone's part of it; the
/// mean over the taps by e / (3 v). An e of v / 16 is two percent of the contrast along the smear,
/// and the smear ends e pixels from where it should.
SHUTTER_INLINE float uniformBound(float dominantPx, float uniformMotionPx) {
    return min(uniformMotionPx, dominantPx * (1.0f / 16.0f));
}

/// \param deviationPx greatest distance of a motion within reach from the dominant one
/// \param depthRange metres between the nearest and the farthest within reach
SHUTTER_INLINE float classifyTile(
    float dominantPx, float deviationPx, float depthRange, float uniformMotionPx,
    float softDepthExtent
) {
    if (dominantPx < kStillPx) return kClassStill;
    // Written so that a NaN deviation is not uniform.
    if (uniformMotionPx > 0.0f && deviationPx <= uniformBound(dominantPx, uniformMotionPx))
        return kClassUniform;
    return depthRange > softDepthExtent ? kClassDeep : kClassMixed;
}

/// How far the motions in a tile are from its longest one, at most: the diagonal of their bounding
/// box, and the amount by which the longest one was clamped to the tile.
SHUTTER_INLINE float tileSpread(vec2 least, vec2 greatest, float longestPx, float limitPx) {
    return length(greatest - least) + max(longestPx - limitPx, 0.0f);
}

/// The tile that holds a position, or the picture's nearest.
SHUTTER_INLINE ivec2 tileAt(vec2 positionPx, uint tileSizePx, uvec2 tileCount) {
    ivec2 tile = ivec2(floor(positionPx / float(tileSizePx)));
    return clamp(tile, ivec2(0), ivec2(tileCount) - 1);
}

// Pixels look up tiles at their centres, or up to a margin beyond. A quarter of a pixel is added: a
// centre may lie at the beginning of a tile, where a quotient with rounding errors, as Vulkan
// permits, has the wrong floor.
SHUTTER_CONST float kTileSlackPx = 0.25f;

/// Of the tiles that the pixels of a block look up, the one nearest to the origin.
/// \param first its first corner
SHUTTER_INLINE ivec2
lowestTile(vec2 first, float marginPx, uint tileSizePx, uvec2 tileCount) {
    return tileAt(first + 0.5f - marginPx - kTileSlackPx, tileSizePx, tileCount);
}

/// Farthest from the origin of them.
/// \param end where the block ends
SHUTTER_INLINE ivec2 highestTile(vec2 end, float marginPx, uint tileSizePx, uvec2 tileCount) {
    return tileAt(end - 0.5f + marginPx + kTileSlackPx, tileSizePx, tileCount);
}

/// Whether a smear no longer than `reachPx` of something in one rectangle comes over the other.
/// Each from its first corner to where it ends.
SHUTTER_INLINE bool reachesBlock(
    vec2 blockFirst, vec2 blockEnd, vec2 tileFirst, vec2 tileEnd, float reachPx
) {
    vec2 gap = max(max(tileFirst - blockEnd, blockFirst - tileEnd), vec2(0.0f));
    // A pixel of slack: smears are measured between centres and end softly.
    return dot(gap, gap) <= (reachPx + 1.0f) * (reachPx + 1.0f);
}

SHUTTER_SHADER_END

#endif
