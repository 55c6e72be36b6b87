// SPDX-License-Identifier: MIT
// Where the taps of the filters without rays lie in the exposure, and how far a smear reaches.
#ifndef SHUTTER_MOTION_BLUR_TAPS_GLSL
#define SHUTTER_MOTION_BLUR_TAPS_GLSL

#include "common/numeric.glsl"
#include "common/shutter_response.glsl"
#include "motion_blur/weights.glsl"

SHUTTER_SHADER_BEGIN

// A surface with motion m that a pixel sees at time s is at u m from it in the raster, u = s_r - s:
// the taps fill [s_r - 1, s_r]. The publications write for a centred exposure, s_r = 1/2, where
// that is one half velocity to each side; another phase moves the same taps along the motion.

/// Tap `index` of `count` strata of equal length, u.
/// \param offset in the stratum, [0, 1)
SHUTTER_INLINE float tapPosition(uint index, float offset, uint count, float rasterTime) {
    return (float(index) + offset) / float(count) + rasterTime - 1.0f;
}

/// Tap `index` of `count` between the ends of the range, neither of which is met (McGuire 2012 and
/// Guertin 2014: t = mix(-1, 1, (i + j + 1) / (S + 1)) of a half velocity), u.
/// \param jitter j, in taps
SHUTTER_INLINE float innerTapPosition(uint index, float jitter, uint count, float rasterTime) {
    return (float(index) + 1.0f + jitter) / float(count + 1u) + rasterTime - 1.0f;
}

/// Warps a tap of the two above, which fill the exposure evenly, by the shutter's response, so that
/// all taps have equal weight. A surface at constant speed is then weighted by the response; the
/// reach of a smear and a publication's tap weights do not change.
SHUTTER_INLINE float warpTap(ResponseRef response, float u, float rasterTime) {
    return rasterTime - inverseResponse(response, rasterTime - u);
}

/// The even tap that warpTap() takes to 0, the pixel itself.
SHUTTER_INLINE float findCentreTap(ResponseRef response, float rasterTime) {
    return rasterTime - cumulativeResponse(response, rasterTime);
}

#ifndef __cplusplus
/// warpTap() of the table at an address; a box (0) leaves u as it is, bit for bit.
float warpTapAt(uvec2 response, float u, float rasterTime) {
    if ((response.x | response.y) == 0u) return u;
    return warpTap(ResponseRef(response), u, rasterTime);
}

/// findCentreTap() of the table at an address.
float findCentreTapAt(uvec2 response, float rasterTime) {
    if ((response.x | response.y) == 0u) return 0.0f;
    return findCentreTap(ResponseRef(response), rasterTime);
}
#endif

/// Share of the exposure that a surface at `offset` from a pixel has to come over it: before the
/// raster instant where it moves towards offset, after it where it moves away. In a centred exposure
/// the half velocity of the publications.
SHUTTER_INLINE float reachShare(vec2 offset, vec2 motion, float rasterTime) {
    return dot(offset, motion) >= 0.0f ? rasterTime : 1.0f - rasterTime;
}

/// How far the smear of `motion` reaches along `offset` from where the raster has it, pixels.
SHUTTER_INLINE float smearReach(vec2 offset, vec2 motion, float rasterTime) {
    return length(motion) * reachShare(offset, motion, rasterTime);
}

/// Displacement of the tile lookup that hides the borders of tiles as noise: along one axis, never
/// into a diagonal tile (Guertin 2014; Jimenez 2014). A quarter of a tile to each side makes both
/// tiles equally likely at a border, and the other one less likely in proportion to the distance
/// from it.
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
