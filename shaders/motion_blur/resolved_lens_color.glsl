// SPDX-License-Identifier: MIT
// Colour of a lens sample. The including shader provides the push constants `params` and `method`.
#ifndef SHUTTER_RESOLVED_LENS_COLOR_GLSL
#define SHUTTER_RESOLVED_LENS_COLOR_GLSL

#include "motion_blur/bright_points_shared.h"
#include "motion_blur/resolved_lens.glsl"
#include "motion_blur/resolved_search.glsl"

/// Diameter of the circle of confusion of what was found, pixels.
float confusionOf(Seen seen) {
    if (seen.key == kSkyKey) return confusionAt(InstantMotionsRef(method.motions), kFarthest);
    // The sample of a plane has no depth.
    float depth = seen.key == kNoKey ? fetchSurfaceAt(seen.layer, seen.at).depth : seen.depth;
    return confusionAt(InstantMotionsRef(method.motions), depth);
}

/// The sample with the place that its colour is fetched at.
Seen placeForColor(Seen seen, uint instant) {
    if (!kHasLens || seen.key == kNoKey) return seen; // the sample of a plane has it
    float along = seen.key == kSkyKey ? 0.0f : alongOf(seen.depth, true);
    vec2 at = seen.at + shiftForInterpolation(InstantMotionsRef(method.motions), instant, along);
    if (!isInside(at)) return seen;
    Probe surface = fetchSurfaceAt(seen.layer, at);
    if (!isOf(surface, seen.key, seen.range)) return seen;
    seen.at = at;
    seen.isInner = isInner(surface.innerCorners, at - floor(at));
    return seen;
}

/// The colour of a surface without the light of a point that was taken out of this frame's raster: its
/// disc has all of it.
/// \param depth at the instant
/// \param place in the picture that it is seen from
vec3 withoutPoint(vec3 color, uint key, float depth, PixelSearch search, vec2 place, uint instant) {
    uint mover = findMover(search.raster, key);
    if (mover == kNoMover || isDeformed(mover)) return color;
    InstantMotion motion = motionAt(method, kHasLens, search.raster, mover, instant);
    vec3 inRaster =
        transformRows(motion.rasterFromInstant, pictureSpace(place, depthOfKey(key, depth), true));
    vec2 at = projectPicture(inRaster, true);
    if (inRaster.z < kMinDepth || !isInside(at)) return color;
    Footprint footprint = footprintOf(at);
    for (uint i = 0u; i < 4u; ++i) {
        ivec2 texel = texelOf(footprint, i);
        vec4 taken = textureLod(uColor, uvOf(vec2(texel) + 0.5f), 0.0f);
        if (taken.a == kTakenOutAlpha && fetchSurface(kRasterLayer, texel).key == key)
            return min(color, taken.rgb);
    }
    return color;
}

vec3 colorThroughLens(Seen seen, PixelSearch search, uint instant) {
    vec3 color = colorOf(placeForColor(seen, instant));
    // Points are taken out of no other raster.
    if (!kHasLens || seen.layer == kRasterLayer || seen.key == kNoKey) return color;
    return withoutPoint(color, seen.key, seen.depth, search, search.x, instant);
}

#endif
