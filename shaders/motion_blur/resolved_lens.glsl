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
/// lens moves a surface. Linear interpolation blurs by itself, so a smaller disc blurs as the lens does. Of
/// step edges at any angle and place in box pixels, 0.28, 0.48, 0.58, 0.68, 0.72, 0.80 and 0.88 of the way
/// err least, squared, for radii of 0.3, 0.5, 0.7, 0.85, 0.99, 1.2 and 1.5 pixels; what is used here has at
/// most 0.2 dB less.
/// \param radius of the circle of confusion, pixels
float shareForInterpolation(float radius) {
    return 1.0f - inversesqrt(1.0f + 0.75f / max(radius * radius, 1.0e-6f));
}

/// What is added to the place that a sample's colour is fetched at.
/// \param along 1 / depth
vec2 shiftForInterpolation(InstantMotionsRef motions, uint instant, float along) {
    vec2 confusion = motions.value.confusion;
    vec4 lens = lensOf(motions, instant);
    float share = shareForInterpolation(abs(confusion.x - confusion.y * along));
    return share * (lens.xy + lens.zw * along);
}

/// From where the middle set samples a plane to where another set does.
struct SetStep {
    vec2 step_; // pixels
    vec2 perY;  // its change per pixel down the block
};

/// A sloping plane is at another depth there, by which the lens moves it further (BlockSample).
/// \param blockSample,change of the sample
/// \param inBlock of the pixel, from the block's centre
SetStep stepOfSet(
    InstantMotionsRef motions, BlockSample blockSample, BlockSample change, uint sample_, uint set,
    vec2 inBlock
) {
    vec2 own = lensOf(motions, sample_ * kLensSets + set).zw;
    vec2 way = own - lensOf(motions, sample_ * kLensSets + kMiddleLensSet).zw;
    vec2 slope = unpackHalf2x16(change.perX);
    slope /= 1.0f + dot(slope, own);
    float along = change.place.x - dot(slope, inBlock + change.place.x * way);
    vec2 wayInRaster =
        unpackHalf2x16(blockSample.perX) * way.x + unpackHalf2x16(blockSample.perY) * way.y;
    return SetStep(wayInRaster * along, wayInRaster * -slope.y);
}

/// Alpha of a pixel whose samples have places of its own, for lens_filter.comp.
/// \param confusionPx least diameter of a circle of confusion among them
float alphaForFilter(ResolvedParams method, float confusionPx) {
    if (!has(method, kFiltersLens)) return 1.0f;
    float radius = min(kLensFilterShare * confusionPx, kMaxLensFilterPx);
    return radius >= kMinLensFilterPx ? -radius : 1.0f;
}

#endif
