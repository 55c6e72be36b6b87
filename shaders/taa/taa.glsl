// SPDX-License-Identifier: MIT
// What becomes of the colour that was kept of a pixel. Colours are compared and mixed by
// brightness as it is seen, so that a single bright sample does not outweigh all others (Karis
// 2014, "High Quality Temporal Supersampling").
#ifndef SHUTTER_TAA_GLSL
#define SHUTTER_TAA_GLSL

#include "common/numeric.glsl"

SHUTTER_SHADER_BEGIN

/// Half the width of the box that the kept colour must lie in, in standard deviations of
/// the pixel's neighbourhood (Salvi 2016, "An Excursion in Temporal Supersampling").
SHUTTER_CONST float kClipDeviations = 2.0f;

/// Colours that a display shows are as they are; what is brighter is brought to below 2, channel by
/// channel by the same factor.
SHUTTER_INLINE vec3 compress(vec3 color) {
    float peak = max(max(color.x, color.y), color.z);
    return peak > 1.0f ? color * ((2.0f - 1.0f / peak) / peak) : color;
}

/// Inverse of compress() up to kMaxColor.
SHUTTER_INLINE vec3 expand(vec3 color) {
    float peak = max(max(color.x, color.y), color.z);
    return peak > 1.0f ? color / (peak * max(2.0f - peak, 1.0f / kMaxColor)) : color;
}

/// Luma and two differences of colour: boxes along these axes fit colours of neighbours better
/// than boxes along red, green and blue.
SHUTTER_INLINE vec3 ycocgFromRgb(vec3 c) {
    return vec3(
        0.25f * c.x + 0.5f * c.y + 0.25f * c.z,
        0.5f * c.x - 0.5f * c.z,
        -0.25f * c.x + 0.5f * c.y - 0.25f * c.z
    );
}

SHUTTER_INLINE vec3 rgbFromYcocg(vec3 c) {
    float t = c.x - c.z;
    return vec3(t + c.y, c.x + c.z, t - c.y);
}

/// Colours of a neighbourhood, summed.
struct ColorMoments {
    vec3 sum;
    vec3 squares;
    float count;
};

SHUTTER_INLINE ColorMoments addColor(ColorMoments moments, vec3 color) {
    moments.sum += color;
    moments.squares += color * color;
    moments.count += 1.0f;
    return moments;
}

struct Clipped {
    vec3 color;
    float beyond; // distance from the box's middle in half its widths; above 1: it was clipped
};

/// The colour itself, if it lies in the box around the neighbourhood's mean, else where the way
/// from it to the mean enters the box.
SHUTTER_INLINE Clipped clipToVariance(vec3 color, ColorMoments moments) {
    vec3 mean = moments.sum / moments.count;
    vec3 variance = max(moments.squares / moments.count - mean * mean, vec3(0.0f));
    vec3 extent = kClipDeviations * sqrt(variance) + vec3(1.0e-4f);
    vec3 away = color - mean;
    vec3 units = abs(away / extent);
    float beyond = max(max(units.x, units.y), units.z);
    Clipped clipped;
    clipped.color = beyond > 1.0f ? mean + away / beyond : color;
    clipped.beyond = beyond;
    return clipped;
}

/// Weights of samples one pixel apart in what is seen at the pixel's middle, by the quadratic
/// B-spline: they add up to 1 wherever the samples lie.
/// \param offset of the middle sample from the pixel's middle, pixels, [-0.5, 0.5]
SHUTTER_INLINE vec3 findMiddleWeights(float offset) {
    float before = 0.5f - offset;
    float after = 0.5f + offset;
    return vec3(0.5f * after * after, 0.75f - offset * offset, 0.5f * before * before);
}

/// What a pixel keeps for the frames after.
struct Kept {
    vec3 color;  // linear
    float count; // of frames it is the mean of
};

/// \param current this frame's colour, linear and storable
/// \param last what was kept; NaN, infinity and a count below 1 count as nothing
/// \param mayDiffer the surface may look different than before: `last` must lie among the moments
/// \param moments of the neighbourhood, compressed YCoCg
SHUTTER_INLINE Kept
mixWithLast(vec3 current, Kept last, float leastShare, bool mayDiffer, ColorMoments moments) {
    bool isUsable = isFinite(last.color.x) && isFinite(last.color.y) && isFinite(last.color.z) &&
                    isFinite(last.count) && last.count >= 1.0f;
    Kept kept;
    kept.color = current;
    kept.count = 1.0f;
    if (!isUsable)
        return kept;
    vec3 now = ycocgFromRgb(compress(current));
    vec3 before = ycocgFromRgb(compress(max(last.color, vec3(0.0f))));
    float trusted = last.count;
    if (mayDiffer) {
        Clipped clipped = clipToVariance(before, moments);
        before = clipped.color;
        // What had to be clipped is out of date, at least in part: fewer frames vouch for it.
        trusted = max(1.0f, trusted / max(clipped.beyond * clipped.beyond, 1.0f));
    }
    float share = max(1.0f / (trusted + 1.0f), leastShare);
    kept.color = storableColor(expand(rgbFromYcocg(mix(before, now, share))));
    kept.count = min(trusted + 1.0f, 1.0f / leastShare);
    return kept;
}

SHUTTER_SHADER_END

#endif
