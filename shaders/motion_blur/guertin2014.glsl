// SPDX-License-Identifier: MIT
// Guertin, McGuire, Nowrouzezahrai: "A Fast and Stable Feature-Aware Motion Blur Filter", HPG 2014.
#ifndef SHUTTER_MOTION_BLUR_GUERTIN2014_GLSL
#define SHUTTER_MOTION_BLUR_GUERTIN2014_GLSL

#include "motion_blur/taps.glsl"

SHUTTER_SHADER_BEGIN

/// Largest jitter eta (pixels) and its baseline phi (section 5): taps are moved by up to eta phi / N
/// of their distance. More than one distance would mix up their order, which N = 35 never does.
SHUTTER_INLINE float guertinJitter(uint sampleCount) {
    return min(0.95f * 27.0f / float(sampleCount), 1.0f);
}

/// Whether the smear of a tile at `offset` tiles can come over this one: its line must pass, so the
/// motion points along the offset or against it on every axis on which there is one.
SHUTTER_INLINE bool reachesTile(ivec2 offset, vec2 motion) {
    float alongX = sign(float(offset.x) * motion.x);
    float alongY = sign(float(offset.y) * motion.y);
    float axes = (offset.x != 0 ? 1.0f : 0.0f) + (offset.y != 0 ? 1.0f : 0.0f);
    return abs(alongX + alongY) == axes;
}

/// |cos| of the angle between two motions, 0 where one is none.
SHUTTER_INLINE float alignment(vec2 a, vec2 b) {
    float lengths = length(a) * length(b);
    return lengths > 0.0f ? min(abs(dot(a, b)) / lengths, 1.0f) : 0.0f;
}

/// Unit direction of the second set of taps (eq. 1): the pixel's own motion, and the slower it is
/// the more the perpendicular to the dominant one.
/// \param dominantDirection unit
/// \param thresholdPx gamma, of half velocities
SHUTTER_INLINE vec2 centreDirection(vec2 motion, vec2 dominantDirection, float thresholdPx) {
    vec2 across = vec2(-dominantDirection.y, dominantDirection.x);
    if (dot(across, motion) < 0.0f) across = -across;
    float speed = length(motion);
    float share = saturate((0.5f * speed - 0.5f) / thresholdPx);
    if (share <= 0.0f) return across;
    // The two never point against each other: the blend is no shorter than 1 / sqrt(2).
    return normalize(mix(across, motion / speed, share));
}

/// Whether tap `index` goes along the second direction, of which a share `variance` does, evenly
/// spread.
SHUTTER_INLINE bool isSecondDirection(uint index, float variance) {
    return floor(float(index + 1u) * variance) > floor(float(index) * variance);
}

/// Weight of a sample `distancePx` away.
/// \param z (target depth - sample depth) / SOFT_Z_EXTENT: positive when the target is deeper
/// \param targetAlong |cos| between the tap's direction and centreDirection()
/// \param sampleAlong |cos| between the tap's direction and the sample's motion
SHUTTER_INLINE float guertinWeight(
    float z, float distancePx, float sampleReachPx, float targetReachPx, float targetAlong,
    float sampleAlong
) {
    float front = saturate(1.0f + z) * cone(distancePx, sampleReachPx) * sampleAlong;
    float behind = saturate(1.0f - z) * cone(distancePx, targetReachPx) * targetAlong;
    float both = 2.0f * cylinder(distancePx, min(sampleReachPx, targetReachPx));
    return front + behind + both * max(targetAlong, sampleAlong);
}

/// Weight of the target itself: N / (kappa |v|), v a half velocity of at least half a pixel.
SHUTTER_INLINE float guertinCentreWeight(float speedPx, uint sampleCount, float kappa) {
    return float(sampleCount) / kappa * centreWeight(0.5f * speedPx);
}

SHUTTER_SHADER_END

#endif
