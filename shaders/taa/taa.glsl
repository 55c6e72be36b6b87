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

/// A pixel's history. Sums are whole numbers, so that they do not depend on the order of frames.
struct Kept {
    ivec3 sum;   // of compressed colours, in steps of 1 / kSteps
    float count; // of frames in the sum, or in what fades, up to below kPlaceCount + 1; 0: none
    uint left;   // kPlaceCount: the mean was in doubt; fewer: frames until it has faded; 0: it is sure
    vec3 fading; // mean, compressed, in whose place the sum comes
};

SHUTTER_INLINE bool fades(Kept kept) {
    return kept.left > 0u && kept.left < kPlaceCount;
}

// A sum that replaces what fades shares its words with it: 21 bits, and 11 for the square root.
SHUTTER_CONST uint kSumBits = 21u;
SHUTTER_CONST uint kDroppedBits = 8u; // of a sum below 2 * kPlaceCount * kSteps
SHUTTER_CONST float kMostRoot = 2047.0f;

SHUTTER_INLINE int packSum(int sum, float fading) {
    uint rounded = (uint(sum) + (1u << (kDroppedBits - 1u))) >> kDroppedBits;
    uint root = uint(sqrt(0.5f * fading) * kMostRoot + 0.5f);
    return int(min(rounded, (1u << kSumBits) - 1u) | root << kSumBits);
}

SHUTTER_INLINE ivec3 packSums(Kept kept) {
    if (!fades(kept)) return kept.sum;
    return ivec3(
        packSum(kept.sum.x, kept.fading.x), packSum(kept.sum.y, kept.fading.y),
        packSum(kept.sum.z, kept.fading.z)
    );
}

/// In one word, whose last bits are a fraction of the count.
SHUTTER_INLINE int packCounts(Kept kept) {
    return int(uint(kept.count * 256.0f + 0.5f) | kept.left << 16u);
}

SHUTTER_INLINE Kept unpackKept(ivec3 sums, int counts) {
    Kept kept;
    kept.sum = sums;
    kept.count = float(uint(counts) & 0xFFFFu) / 256.0f;
    kept.left = uint(counts) >> 16u;
    kept.fading = vec3(0.0f);
    if (fades(kept)) {
        uvec3 words = uvec3(sums);
        kept.sum = ivec3((words & ((1u << kSumBits) - 1u)) << kDroppedBits);
        vec3 roots = vec3(words >> kSumBits) / kMostRoot;
        kept.fading = 2.0f * roots * roots;
    }
    return kept;
}

/// \param compressed [0, 2]
SHUTTER_INLINE ivec3 toSteps(vec3 compressed) {
    return ivec3(compressed * kSteps + 0.5f);
}

/// Number of frames that the mean is worth. What fades loses its share as fast as frames come in.
SHUTTER_INLINE float countOf(Kept kept) {
    if (!fades(kept)) return kept.count;
    return kept.count * float(kept.left) / float(kPlaceCount) + float(kPlaceCount - kept.left);
}

/// Compressed. \param kept of one frame or more
SHUTTER_INLINE vec3 meanOf(Kept kept) {
    vec3 sum = vec3(kept.sum) / kSteps;
    if (fades(kept)) sum += kept.fading * (kept.count * float(kept.left) / float(kPlaceCount));
    return sum / countOf(kept);
}

/// Adds a frame, unless the pixel has had one for each place: its mean then stays constant, so that
/// it does not flicker. A mean that was in doubt fades, each frame by an equal part, until one frame
/// for each place has replaced it: then nothing of it is left, and all places count alike.
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
        float trusted = max(1.0f, countOf(last) / max(clipped.beyond * clipped.beyond, 1.0f));
        trusted = min(floor(trusted * 256.0f) / 256.0f, float(kPlaceCount - 1u)); // as it is packed
        kept.sum = toSteps(mean * trusted + current);
        kept.count = trusted + 1.0f;
        kept.left = kPlaceCount;
    } else if (last.left > 0u) {
        if (last.left == kPlaceCount) {
            kept.fading = meanOf(last);
            kept.sum = ivec3(0);
        }
        kept.sum += toSteps(current);
        kept.left = last.left - 1u;
        if (kept.left == 0u) kept.count = float(kPlaceCount);
    } else if (last.count < float(kPlaceCount)) {
        kept.sum = last.sum + toSteps(current);
        kept.count = last.count + 1.0f;
    }
    return kept;
}

SHUTTER_SHADER_END

#endif
