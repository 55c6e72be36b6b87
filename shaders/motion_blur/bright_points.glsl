// SPDX-License-Identifier: MIT
// The disc of a bright point out of focus: the image of the lens's opening, which has the light of the
// point. The including shader has the push constants `params` and `method`.
#ifndef SHUTTER_BRIGHT_POINTS_GLSL
#define SHUTTER_BRIGHT_POINTS_GLSL

#include "common/disc_share.glsl"
#include "motion_blur/bright_points_shared.h"
#include "motion_blur/resolved.glsl"

uvec2 countRegions(uvec2 sizePx) { return (sizePx + kPointRegionPx - 1u) / kPointRegionPx; }

/// Where a disc lies at a sample's time.
struct Disc {
    bool isThere;
    vec2 at;         // of the point as a pinhole sees it
    float along;     // 1 / depth of the point
    float confusion; // radius; negative: the point is nearer than the focus. Pixels
};

Aperture apertureOf(InstantMotionsRef motions) {
    vec4 shape = motions.value.aperture;
    return Aperture(uint(shape.x), shape.y, shape.z, shape.w);
}

Disc discAt(BrightPoint point, uint sample_) {
    InstantMotionsRef motions = InstantMotionsRef(method.motions);
    Disc disc = Disc(false, vec2(0.0f), 0.0f, 0.0f);
    InstantMotion motion = pinholeMotion(method, motions.value.raster, point.mover, sample_);
    if (motion.rasterFromInstant[2] == vec4(0.0f)) return disc;
    float depth = point.along > 0.0f ? 1.0f / point.along : 1.0f;
    vec3 seen = transformRows(motion.instantFromRaster, pictureSpace(point.at, depth, true));
    if (!(seen.z >= kMinDepth)) return disc;
    LensReach reach = reachOf(motions, sample_);
    disc.at = projectPicture(seen, true);
    disc.along = point.along > 0.0f ? 1.0f / seen.z : 0.0f;
    disc.confusion = reach.radius * (reach.inverseFocus - disc.along);
    disc.isThere = true;
    return disc;
}

#endif
