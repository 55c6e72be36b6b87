// SPDX-License-Identifier: MIT
// The variance-guided a-trous filter of SVGF (Schied et al. 2017), turned along the motion as
// Oberberger, Chajdas and Westermann 2022 do for motion blur: along it the blurred picture has no
// detail, across it it has all of it.
#ifndef SHUTTER_MOTION_BLUR_DENOISE_GLSL
#define SHUTTER_MOTION_BLUR_DENOISE_GLSL

#include "common/numeric.glsl"

SHUTTER_SHADER_BEGIN

/// Fewer rays give too poor an estimate of their variance: it is then taken from the neighbours
/// (SVGF, section 4.2).
SHUTTER_CONST uint kRaysThatKnowVariance = 4u;

/// Standard deviation of the mean of `count` values at stratified times, from their sum and the sum
/// of their squares; 0 if there are too few. A silhouette passes in one of the strata and leaves
/// the others certain, so that the error falls with the count and not with its root (Mitchell 1996,
/// "Consequences of Stratified Sampling in Graphics").
SHUTTER_INLINE float deviationOfMean(float sum1, float sum2, uint count) {
    if (count < kRaysThatKnowVariance) return 0.0f;
    float n = float(count);
    float variance = max(sum2 - sum1 * sum1 / n, 0.0f) / (n - 1.0f);
    return sqrt(variance) / n;
}

/// Weight of a tap whose luminance is `difference` away (SVGF, eq. 5).
/// \param deviation of the luminance about the pixel
/// \param sigma how many deviations still count as noise
SHUTTER_INLINE float luminanceWeight(float difference, float deviation, float sigma) {
    return exp(-abs(difference) / (sigma * deviation + 1.0e-4f));
}

/// Binomial weight of tap k of the a-trous kernel, k in [-2, 2].
SHUTTER_INLINE float atrousWeight(int k) {
    int a = k < 0 ? -k : k;
    return a == 0 ? 0.375f : (a == 1 ? 0.25f : 0.0625f);
}

/// Taps of level i are 2^i pixels apart. A level whose taps would reach further than the smear does
/// to one side mixes values that no exposure mixes.
SHUTTER_INLINE bool levelFits(float stepPx, float motionPx) {
    return 2.0f * stepPx <= 0.5f * motionPx;
}

SHUTTER_SHADER_END

#endif
