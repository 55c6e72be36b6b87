// SPDX-License-Identifier: MIT
// The colour of a sample that has a place in the lens. Whoever includes this has the push constants
// `params` and `method`.
#ifndef SHUTTER_RESOLVED_LENS_COLOR_GLSL
#define SHUTTER_RESOLVED_LENS_COLOR_GLSL

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
    if (surface.key != seen.key) return seen;
    seen.at = at;
    seen.isInner = isInner(surface.innerCorners, at - floor(at));
    return seen;
}

vec3 colorThroughLens(Seen seen, uint instant) { return colorOf(placeForColor(seen, instant)); }

#endif
