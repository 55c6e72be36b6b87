// SPDX-License-Identifier: MIT
// Where the taps of the filters without rays lie in the exposure, and how far a smear reaches.
#ifndef SHUTTER_MOTION_BLUR_TAPS_GLSL
#define SHUTTER_MOTION_BLUR_TAPS_GLSL

#include "common/numeric.glsl"
#include "motion_blur/weights.glsl"

SHUTTER_SHADER_BEGIN

// What a pixel sees at time s of a surface that moves by m lies at u m from it, u = s_r - s: the taps
// fill [s_r - 1, s_r]. The publications write for a centred exposure, s_r = 1/2, where that is one
// half velocity to each side; another phase moves the same taps along the motion.

/// Tap `index` of `count` strata of equal length, u.
/// \param offset in the stratum, [0, 1)
SHUTTER_INLINE float tapPosition(uint index, float offset, uint count, float rasterShare) {
    return (float(index) + offset) / float(count) + rasterShare - 1.0f;
}

/// Tap `index` of `count` between the ends of the range, neither of which is met (McGuire 2012 and
/// Guertin 2014: t = mix(-1, 1, (i + j + 1) / (S + 1)) of a half velocity), u.
/// \param jitter j, in taps
SHUTTER_INLINE float innerTapPosition(uint index, float jitter, uint count, float rasterShare) {
    return (float(index) + 1.0f + jitter) / float(count + 1u) + rasterShare - 1.0f;
}

/// Share of the exposure that a surface at `offset` from a pixel has to come over it: before the
/// raster instant where it moves towards offset, after it where it moves away. In a centred exposure
/// the half velocity of the publications.
SHUTTER_INLINE float reachShare(vec2 offset, vec2 motion, float rasterShare) {
    return dot(offset, motion) >= 0.0f ? rasterShare : 1.0f - rasterShare;
}

/// How far the smear of `motion` reaches along `offset` from where the raster has it, pixels.
SHUTTER_INLINE float smearReach(vec2 offset, vec2 motion, float rasterShare) {
    return length(motion) * reachShare(offset, motion, rasterShare);
}

/// Displacement of the tile look-up that hides the borders of tiles as noise: along one axis, never
/// into a diagonal tile (Guertin 2014; Jimenez 2014). A quarter of a tile to each side
/// makes the other tile as likely as the own one at a border, less likely in proportion away from it.
/// \param noise [0, 1)
SHUTTER_INLINE vec2 tileJitter(float noise, float tileSizePx) {
    bool alongX = noise < 0.5f;
    float side = 4.0f * noise - (alongX ? 1.0f : 3.0f); // [-1, 1)
    float shift = 0.25f * tileSizePx * side;
    return alongX ? vec2(shift, 0.0f) : vec2(0.0f, shift);
}

/// tileUv() of a pixel moved by tileJitter(), kept in the picture.
/// \param jitter share of the jitter, [0, 1]
SHUTTER_INLINE vec2 jitteredTileUv(
    vec2 centre, float jitter, uint tileSizePx, uvec2 tileCount, uvec2 sizePx
) {
    // Another part of the same noise than the taps take.
    float noise = interleavedGradientNoise(floor(centre) + vec2(47.0f, 17.0f));
    vec2 at = centre + jitter * tileJitter(noise, float(tileSizePx));
    return tileUv(clamp(at, vec2(0.5f), vec2(sizePx) - 0.5f), tileSizePx, tileCount);
}

SHUTTER_SHADER_END

#endif
