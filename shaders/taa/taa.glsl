// SPDX-License-Identifier: MIT
// What becomes of the last picture in this frame's pixel. Colours are compared and mixed by
// brightness as it is seen, so that a single bright sample does not outweigh all others (Karis 2014,
// "High Quality Temporal Supersampling").
#ifndef SHUTTER_TAA_GLSL
#define SHUTTER_TAA_GLSL

#include "common/numeric.glsl"

SHUTTER_SHADER_BEGIN

/// Half the width of the box that the last picture's colour must lie in, in standard deviations of
/// the pixel's neighbourhood (Salvi 2016, "An Excursion in Temporal Supersampling").
SHUTTER_CONST float kClipDeviations = 1.0f;

/// Colours in [0, 1): c / (1 + max(c)), channel by channel the same factor.
SHUTTER_INLINE vec3 compress(vec3 color) {
    return color / (1.0f + max(max(color.x, color.y), color.z));
}

/// Inverse of compress() up to kMaxColor.
SHUTTER_INLINE vec3 expand(vec3 color) {
    return color / max(1.0f - max(max(color.x, color.y), color.z), 1.0f / (1.0f + kMaxColor));
}

/// Luma and two differences of colour: boxes along these axes fit colours of neighbours better
/// than boxes along red, green and blue.
SHUTTER_INLINE vec3 ycocgFromRgb(vec3 c) {
    return vec3(
        0.25f * c.x + 0.5f * c.y + 0.25f * c.z, 0.5f * c.x - 0.5f * c.z,
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

/// The colour itself, if it lies in the box around the neighbourhood's mean, else where the way from
/// it to the mean enters the box.
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

/// Catmull-Rom's cubic as three taps a side, the middle one of two texels by the linear filter
/// (Jimenez 2016, "Filmic SMAA"): where they are, in texels, and what they weigh.
struct CubicTaps {
    vec2 before;
    vec2 middle;
    vec2 after;
    vec2 beforeWeight;
    vec2 middleWeight;
    vec2 afterWeight;
};

/// \param at place in the image, texels
SHUTTER_INLINE CubicTaps findCubicTaps(vec2 at) {
    vec2 texel = floor(at - 0.5f) + 0.5f;
    vec2 f = at - texel;
    vec2 w0 = f * (-0.5f + f * (1.0f - 0.5f * f));
    vec2 w1 = 1.0f + f * f * (-2.5f + 1.5f * f);
    vec2 w2 = f * (0.5f + f * (2.0f - 1.5f * f));
    vec2 w3 = f * f * (-0.5f + 0.5f * f);
    CubicTaps taps;
    taps.before = texel - 1.0f;
    taps.middle = texel + w2 / (w1 + w2);
    taps.after = texel + 2.0f;
    taps.beforeWeight = w0;
    taps.middleWeight = w1 + w2;
    taps.afterWeight = w3;
    return taps;
}

/// What a pixel keeps for the frames after.
struct Kept {
    vec3 color;  // linear
    float count; // of frames it is the mean of
};

/// \param current this frame's colour, linear and storable
/// \param moments of the neighbourhood, compressed YCoCg
/// \param last what the last picture has kept; NaN and infinity count as nothing
SHUTTER_INLINE Kept mixWithLast(vec3 current, ColorMoments moments, Kept last, float leastShare) {
    bool isUsable = isFinite(last.color.x) && isFinite(last.color.y) && isFinite(last.color.z) &&
                    isFinite(last.count) && last.count >= 1.0f;
    Kept kept;
    kept.color = current;
    kept.count = 1.0f;
    if (!isUsable) return kept;
    vec3 now = ycocgFromRgb(compress(current));
    vec3 before = ycocgFromRgb(compress(max(last.color, vec3(0.0f))));
    Clipped clipped = clipToVariance(before, moments);
    // What had to be clipped was of another surface, at least in part: fewer frames vouch for it.
    float trusted = max(1.0f, last.count / max(clipped.beyond * clipped.beyond, 1.0f));
    float share = max(1.0f / (trusted + 1.0f), leastShare);
    kept.color = storableColor(expand(rgbFromYcocg(mix(clipped.color, now, share))));
    kept.count = min(trusted + 1.0f, 1.0f / leastShare);
    return kept;
}

SHUTTER_SHADER_END

#endif
