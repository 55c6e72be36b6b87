// SPDX-License-Identifier: MIT
// Jimenez: "Next Generation Post Processing in Call of Duty: Advanced Warfare", SIGGRAPH 2014,
// motion blur: scatter as you gather: each tap is weighted by whether its smear covers this pixel.
#ifndef SHUTTER_MOTION_BLUR_JIMENEZ2014_GLSL
#define SHUTTER_MOTION_BLUR_JIMENEZ2014_GLSL

#include "motion_blur/taps.glsl"

SHUTTER_SHADER_BEGIN

/// x: the sample counts as background of the target, y: as its foreground; the two sum to 1
/// (DepthCmp).
/// \param z (target depth - sample depth) / SOFT_Z_EXTENT: positive when the target is deeper
SHUTTER_INLINE vec2 classifyDepth(float z) {
    return vec2(saturate(0.5f - z), saturate(0.5f + z));
}

/// 1 within the spread, down to 0 over one tap beyond it (SpreadCmp). Both in distances of taps.
SHUTTER_INLINE float spreadCovers(float spreadTaps, float distanceTaps) {
    return saturate(spreadTaps - distanceTaps + 1.0f);
}

/// A foreground sample covers by its own spread, a background one shows through the target's
/// (SampleWeight). In [0, 1].
SHUTTER_INLINE float jimenezWeight(
    float z, float distanceTaps, float sampleSpreadTaps, float targetSpreadTaps
) {
    vec2 depth = classifyDepth(z);
    return depth.x * spreadCovers(targetSpreadTaps, distanceTaps) +
           depth.y * spreadCovers(sampleSpreadTaps, distanceTaps);
}

/// Weights of the two samples of a pair, mirrored: where one is nearer and faster than the other,
/// it covers the pixel for this share of the exposure and the other is the best estimate of the
/// background, so both get the nearer one's weight.
SHUTTER_INLINE vec2 mirrorWeights(vec2 weights, vec2 depths, vec2 speeds) {
    bool deeper = depths.x > depths.y;
    bool slower = speeds.y > speeds.x;
    return vec2(
        deeper && slower ? weights.y : weights.x, deeper || slower ? weights.y : weights.x
    );
}

SHUTTER_SHADER_END

#endif
