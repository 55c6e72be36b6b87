// SPDX-License-Identifier: MIT
// How widely a lens spreads what a pixel sees, and what the filter after the search reads of it.
#ifndef SHUTTER_RESOLVED_LENS_GLSL
#define SHUTTER_RESOLVED_LENS_GLSL

#include "motion_blur/resolved.glsl"

/// Share of the least circle of confusion that the filter's radius takes.
const float kLensFilterShare = 0.18f;
/// Radii below it gain nothing.
const float kMinLensFilterPx = 0.5f;

/// Diameter of the circle of confusion, pixels.
float confusionAt(InstantMotionsRef motions, float depth) {
    vec2 confusion = motions.value.confusion;
    return 2.0f * abs(confusion.x - confusion.y / max(depth, kMinDepth));
}

/// How far back towards the pixel the colour is fetched from, as a share of the way over which the
/// lens moves a surface. Linear interpolation blurs by itself: at a distance d below 1 it has the second
/// moment d, and 1/6 more than d^2 on the mean of farther ones. So much less of the disc of radius r,
/// whose mean distance along an axis is 4 r / (3 pi) and whose second moment is r^2 / 4, gives the
/// disc's own.
/// \param radius of the circle of confusion, pixels
float shareForInterpolation(float radius) {
    float farther = sqrt(max(1.0f - 0.6667f / max(radius * radius, 1.0e-6f), 0.0f));
    return 1.0f - (radius < 1.0f ? 0.589f * radius : min(0.589f * radius, farther));
}

/// What is added to the place that a sample's colour is fetched at.
/// \param along 1 / depth
vec2 shiftForInterpolation(InstantMotionsRef motions, uint instant, float along) {
    vec2 confusion = motions.value.confusion;
    vec4 lens = lensOf(motions, instant);
    float share = shareForInterpolation(abs(confusion.x - confusion.y * along));
    return share * (lens.xy + lens.zw * along);
}

/// The step from where the middle set samples a plane to where another set does.
/// \param blockSample,change of the sample (BlockSample)
vec2 lookOfSet(InstantMotionsRef motions, BlockSample blockSample, BlockSample change, uint sample_, uint set) {
    vec2 seen = change.place.x * (lensOf(motions, sample_ * kLensSets + set).zw -
                                  lensOf(motions, sample_ * kLensSets + kMiddleLensSet).zw);
    return unpackHalf2x16(blockSample.perX) * seen.x + unpackHalf2x16(blockSample.perY) * seen.y;
}

/// Alpha of a pixel whose samples have places of its own, for lens_filter.comp.
/// \param confusionPx least diameter of a circle of confusion among them
float alphaForFilter(float confusionPx) {
    float radius = min(kLensFilterShare * confusionPx, kMaxLensFilterPx);
    return radius >= kMinLensFilterPx ? -radius : 1.0f;
}

#endif
