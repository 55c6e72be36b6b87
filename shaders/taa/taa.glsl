// SPDX-License-Identifier: MIT
// Update of a pixel's accumulated colour. Colours are compared and mixed by perceived brightness,
// so that a single bright sample does not outweigh all others (Karis 2014, "High Quality Temporal
// Supersampling").
#ifndef SHUTTER_TAA_GLSL
#define SHUTTER_TAA_GLSL

#include "common/numeric.glsl"
#include "taa/taa_shared.h"

SHUTTER_SHADER_BEGIN

/// Half the width of the box that the kept colour must lie in, in standard deviations of
/// the pixel's neighbourhood (Salvi 2016, "An Excursion in Temporal Supersampling").
SHUTTER_CONST float kClipDeviations = 2.0f;

/// Displayable colours do not change; brighter ones are scaled to below 2, all channels by the same
/// factor.
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

/// Weights of samples one pixel apart for the colour at the pixel's centre, by the quadratic
/// B-spline: they sum to 1 for any offset.
/// \param offset of the middle sample from the pixel's middle, pixels, [-0.5, 0.5]
SHUTTER_INLINE vec3 findMiddleWeights(float offset) {
    float before = 0.5f - offset;
    float after = 0.5f + offset;
    return vec3(0.5f * after * after, 0.75f - offset * offset, 0.5f * before * before);
}

/// Steps of 1 in Kept::sum: finer than a half float's where a display can distinguish colours.
SHUTTER_CONST float kSteps = 16777216.0f;

/// A pixel's history. Whole numbers, so that their sum does not depend on the order of frames.
struct Kept {
    ivec3 sum;   // of compressed colours, in steps of 1 / kSteps
    float count; // of frames in the sum, up to below kPlaceCount + 1; 0: none
    uint left;   // frames that the mean still follows, because it was in doubt
};

/// Frames in which a mean adapts after a possible change: 2 % of the outdated colour remain then.
SHUTTER_CONST uint kFollowedFrames = 63u;

/// In one word, whose last bits are a fraction of the count. \param count up to 255
SHUTTER_INLINE int packCounts(Kept kept) {
    return int(uint(kept.count * 256.0f + 0.5f) | kept.left << 16u);
}

SHUTTER_INLINE Kept unpackKept(ivec3 sum, int counts) {
    Kept kept;
    kept.sum = sum;
    kept.count = float(uint(counts) & 0xFFFFu) / 256.0f;
    kept.left = uint(counts) >> 16u;
    return kept;
}

/// \param compressed [0, 2]
SHUTTER_INLINE ivec3 toSteps(vec3 compressed) {
    return ivec3(compressed * kSteps + 0.5f);
}

/// Compressed. \param kept of one frame or more
SHUTTER_INLINE vec3 meanOf(Kept kept) {
    return vec3(kept.sum) / (kept.count * kSteps);
}

/// Adds a frame, unless the pixel has had one for each place and has long been unchanged: its mean
/// then stays constant, so that it does not flicker.
/// \param current this frame's colour, compressed
/// \param mayDiffer the surface may have changed: the mean is clipped to the moments
/// \param moments of the neighbourhood, compressed YCoCg
SHUTTER_INLINE Kept addFrame(vec3 current, Kept last, bool mayDiffer, ColorMoments moments) {
    Kept kept = last;
    if (last.count < 1.0f) {
        kept.sum = toSteps(current);
        kept.count = 1.0f;
        kept.left = 0u;
    } else if (mayDiffer) {
        Clipped clipped = clipToVariance(ycocgFromRgb(meanOf(last)), moments);
        vec3 mean = min(max(rgbFromYcocg(clipped.color), vec3(0.0f)), vec3(2.0f));
        // What had to be clipped is out of date, at least in part: fewer frames vouch for it.
        float trusted = max(1.0f, last.count / max(clipped.beyond * clipped.beyond, 1.0f));
        trusted = min(floor(trusted * 256.0f) / 256.0f, float(kPlaceCount - 1u)); // as it is packed
        kept.sum = toSteps(mean * trusted + current);
        kept.count = trusted + 1.0f;
        kept.left = kFollowedFrames;
    } else if (last.count < float(kPlaceCount)) {
        kept.sum = last.sum + toSteps(current);
        kept.count = last.count + 1.0f;
    } else if (last.left > 0u) {
        kept.sum = toSteps(meanOf(last) * float(kPlaceCount - 1u) + current);
        kept.count = float(kPlaceCount);
        kept.left = last.left - 1u;
    }
    return kept;
}

SHUTTER_SHADER_END

#endif
