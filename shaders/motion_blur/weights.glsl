// SPDX-License-Identifier: MIT
// The gather's weights: McGuire et al. 2012 as Tan et al. adapt them (appendix of "Hybrid MBlur").
#ifndef SHUTTER_MOTION_BLUR_WEIGHTS_GLSL
#define SHUTTER_MOTION_BLUR_WEIGHTS_GLSL

#include "common/numeric.glsl"

SHUTTER_SHADER_BEGIN

/// A dot that is spread over v pixels is there for 1/v of the exposure: how far along the smear it
/// still counts. 0 at and beyond its end, 0 for a still pixel.
SHUTTER_INLINE float cone(float distancePx, float speedPx) {
    return saturate(1.0f - distancePx / max(speedPx, 1.0e-3f));
}

/// 1 inside the smear, 0 outside, smooth over a tenth of it (cylinder).
SHUTTER_INLINE float cylinder(float distancePx, float speedPx) {
    float t = saturate((distancePx - 0.95f * speedPx) / max(0.1f * speedPx, 1.0e-6f));
    return 1.0f - t * t * (3.0f - 2.0f * t);
}

/// How far along a smear a distance lies, 1 at its end. Of a still one everything is beyond the end.
SHUTTER_INLINE float smearRatio(float distancePx, float speedPx) {
    return distancePx / max(speedPx, 1.0e-3f);
}

/// cylinder() of a smearRatio(): one division serves cone and cylinder.
SHUTTER_INLINE float cylinderAt(float ratio) {
    float t = saturate(10.0f * ratio - 9.5f);
    return 1.0f - t * t * (3.0f - 2.0f * t);
}

/// sampleWeight() of smearRatio()s.
SHUTTER_INLINE float sampleWeightAt(
    float z, float sampleRatio, float targetRatio, float magnification
) {
    float front = saturate(1.0f + z) * saturate(1.0f - sampleRatio);
    front *= z >= 1.0f ? magnification : 1.0f;
    float behind = saturate(1.0f - z) * saturate(1.0f - targetRatio);
    return front + behind + 2.0f * cylinderAt(sampleRatio) * cylinderAt(targetRatio);
}

/// w = w_f + w_b + w_s of a sample at `distancePx` from the target.
/// \param z (target depth - sample depth) / SOFT_Z_EXTENT: positive when the target is deeper
/// \param magnification w_f is multiplied by it where the target is deeper by the whole extent
SHUTTER_INLINE float sampleWeight(
    float z, float distancePx, float sampleSpeedPx, float targetSpeedPx, float magnification
) {
    return sampleWeightAt(
        z, smearRatio(distancePx, sampleSpeedPx), smearRatio(distancePx, targetSpeedPx),
        magnification
    );
}

/// sampleWeight() of two at one depth that move alike.
SHUTTER_INLINE float uniformWeight(float ratio) {
    float both = cylinderAt(ratio);
    return 2.0f * (saturate(1.0f - ratio) + both * both);
}

/// Weight of the target itself (McGuire 2012: 1 / |V|), bounded for a still one.
SHUTTER_INLINE float centreWeight(float targetSpeedPx) { return 1.0f / max(targetSpeedPx, 0.5f); }

/// Interleaved gradient noise, Jimenez 2014: [0, 1).
SHUTTER_INLINE float interleavedGradientNoise(vec2 pixel) {
    return fract(52.9829189f * fract(0.06711056f * pixel.x + 0.00583715f * pixel.y));
}

/// SOFT_Z_EXTENT: depth over which foreground and background mix, metres. Never 0, so that it divides.
/// \param extent metres everywhere (McGuire 2012)
/// \param share of the depth, for scenes of any scale
SHUTTER_INLINE float softExtent(float depth, float extent, float share) {
    return max(extent + share * depth, 1.0e-6f);
}

/// Whether `b` is longer than `a`; ties go to the greater x, then y, so that the order in which
/// tiles are visited does not matter.
/// \param la, lb their squared lengths
SHUTTER_INLINE bool isLonger(vec2 b, float lb, vec2 a, float la) {
    // One condition: branches per pixel would cost more than the comparison.
    bool later = b.x > a.x || (b.x == a.x && b.y > a.y);
    return lb > la || (lb == la && later);
}

/// The longer of two motions. `b` is passed over where its length is not finite, so that a search
/// that starts from 0 ends with a motion that is.
SHUTTER_INLINE vec2 longerMotion(vec2 a, vec2 b) {
    float lb = dot(b, b);
    return isFinite(lb) && isLonger(b, lb, a, dot(a, a)) ? b : a;
}

/// Where the tile of a pixel's centre is in a texture of one texel a tile. In floats and for a
/// sampler: integer division and texelFetch are slow on software devices; half a pixel of slack
/// makes the quotient's floor exact.
SHUTTER_INLINE vec2 tileUv(vec2 centre, uint tileSizePx, uvec2 tileCount) {
    return (floor(centre / float(tileSizePx)) + 0.5f) / vec2(tileCount);
}

/// `motion` no longer than `limitPx`. One without a finite length (NaN, infinity, overflow) counts as
/// none: scaling it would make NaN.
SHUTTER_INLINE vec2 clampMotion(vec2 motion, float limitPx) {
    float speed = length(motion);
    if (!isFinite(speed)) return vec2(0.0f);
    return speed > limitPx ? motion * (limitPx / speed) : motion;
}

/// `motion` as the filters see it: none where it is not finite, nor beyond the depth to which motion
/// is shown (Tan et al.: velocity limited to a user-defined depth).
SHUTTER_INLINE vec2 shownMotion(vec2 motion, float depth, float maxMotionDepth) {
    bool shown = isFinite(dot(motion, motion)) && depth <= maxMotionDepth;
    return shown ? motion : vec2(0.0f);
}

/// shownMotion() no longer than `limitPx`.
/// \param motionDepth motion and depth, as the G-buffer has them
SHUTTER_INLINE vec2 limitMotion(vec3 motionDepth, float limitPx, float maxMotionDepth) {
    vec2 motion = vec2(motionDepth.x, motionDepth.y);
    return clampMotion(shownMotion(motion, motionDepth.z, maxMotionDepth), limitPx);
}

/// Length of a motion, 0 where that is not finite: clampMotion() without a limit.
SHUTTER_INLINE float finiteSpeed(vec2 motion) {
    float speed = length(motion);
    return isFinite(speed) ? speed : 0.0f;
}

SHUTTER_SHADER_END

#endif
