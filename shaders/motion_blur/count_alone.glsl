// SPDX-License-Identifier: MIT
// Counts a surface of the raster along its own path. Before it: `params`, and textures uColor,
// uMotionDepth and uEntityId.
#ifndef SHUTTER_MOTION_BLUR_COUNT_ALONE_GLSL
#define SHUTTER_MOTION_BLUR_COUNT_ALONE_GLSL

#include "motion_blur/count_taps.glsl"
#include "motion_blur/motion_arc.glsl"

Surface surfaceInRaster(vec2 centre) {
    vec2 uv = uvOf(centre);
    return makeSurface(
        centre, textureLod(uEntityId, uv, 0.0f).x, shownMotionDepth(uMotionDepth, uv),
        textureLod(uColor, uv, 0.0f).rgb
    );
}

/// Change of the motion from the pixel to its neighbour, or from the one before it; 0 where neither
/// shows the same surface.
vec2 slopeOfMotion(Surface surface, vec2 toNeighbour) {
    for (float side = 1.0f; side > -2.0f; side -= 2.0f) {
        vec2 uv = uvOf(surface.centre + side * toNeighbour);
        if (textureLod(uEntityId, uv, 0.0f).x != surface.id) continue;
        vec3 there = shownMotionDepth(uMotionDepth, uv);
        if (abs(there.z - surface.motionDepth.z) > softExtentAt(surface.motionDepth.z)) continue;
        return side * (there.xy - surface.motionDepth.xy);
    }
    return vec2(0.0f);
}

Arc findArc(Surface surface) {
    return makeArc(
        surface.motionDepth.xy, slopeOfMotion(surface, vec2(1.0f, 0.0f)),
        slopeOfMotion(surface, vec2(0.0f, 1.0f)), params.rasterTime
    );
}

/// The mean over the taps of a surface that nothing hides or uncovers.
vec3 countAlone(Surface surface) {
    vec2 motion = surface.motionDepth.xy;
    if (dot(motion, motion) < kStillPx * kStillPx) return surface.color;
    Arc arc = findArc(surface);
    float firstTap = placeFirstTap(surface.centre);
    vec3 sum = vec3(0.0f);
    for (uint i = 0u; i < countTaps(); ++i) {
        vec2 offset = placeOnArc(arc, placeTap(i, firstTap));
        sum += textureLod(uColor, uvOf(surface.centre + offset), 0.0f).rgb;
    }
    return sum / float(countTaps());
}

#endif
