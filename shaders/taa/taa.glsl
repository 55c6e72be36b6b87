// SPDX-License-Identifier: MIT
// What becomes of the last picture in this frame's pixel. Colours are compared and mixed by
// brightness as it is seen, so that a single bright sample does not outweigh all others (Karis
// 2014, "High Quality Temporal Supersampling").
#ifndef SHUTTER_TAA_GLSL
#define SHUTTER_TAA_GLSL

#include "common/numeric.glsl"

SHUTTER_SHADER_BEGIN

/// Half the width of the box that the last picture's colour must lie in, in standard deviations of
/// the pixel's neighbourhood (Salvi 2016, "An Excursion in Temporal Supersampling").
SHUTTER_CONST float kClipDeviations = 2.0f;

/// By how much two depths of one surface differ at most between neighbouring texels and frames, as
/// a share of the farther one.
SHUTTER_CONST float kSameDepthShare = 0.02f;

/// How far two surfaces that move alike get apart between two frames, pixels.
SHUTTER_CONST float kApartPx = 0.5f;

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

/// Weights of samples one pixel apart in what is seen at the pixel's middle, by the quadratic
/// B-spline: they add up to 1 wherever the samples lie.
/// \param offset of the middle sample from the pixel's middle, pixels, [-0.5, 0.5]
SHUTTER_INLINE vec3 findMiddleWeights(float offset) {
    float before = 0.5f - offset;
    float after = 0.5f + offset;
    return vec3(0.5f * after * after, 0.75f - offset * offset, 0.5f * before * before);
}

/// Whether something at a depth is clearly nearer than what lies at another one, and hides it.
/// Metres.
SHUTTER_INLINE bool hides(float depth, float other) {
    return depth < other * (1.0f - kSameDepthShare);
}

/// Whether what is seen at a pixel's edge has moved as the pixel has. If so, samples of either may
/// fall into the pixel, in this frame as in the last one. \param displacement of the pixel, and of
/// the edge, since the last frame, pixels
SHUTTER_INLINE bool movesAlong(vec2 displacement, vec2 edge) {
    vec2 apart = edge - displacement;
    return dot(apart, apart) < kApartPx * kApartPx;
}

/// Depths at which the last frame may have seen what a pixel shows, metres.
struct DepthRange {
    float least;
    float most;
};

/// Whether the last frame's sample was of what the pixel shows: nothing was in front of it then,
/// and it was there.
SHUTTER_INLINE bool wasSeen(DepthRange depths, float sampled) {
    return !hides(sampled, depths.least) && !hides(depths.most, sampled);
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
    if (!isUsable)
        return kept;
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
