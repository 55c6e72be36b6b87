// SPDX-License-Identifier: MIT
// The colour of a sample that no layer holds, because this frame's raster shows something nearer
// there. The including shader has the push constants `params` and `method`.
#ifndef SHUTTER_RESOLVED_HIDDEN_GLSL
#define SHUTTER_RESOLVED_HIDDEN_GLSL

#include "motion_blur/resolved_search.glsl"

/// Steps from a hidden place to where the surface is seen: of a pixel each, unless the way is longer.
const uint kWalkSteps = 32u;
/// In place of a key: whatever is static before a static camera, which is no candidate.
const uint kStaticKey = kNoKey;

/// The substitute for a hidden surface's color.
struct Substitute {
    float distancePx; // from the hidden place to the nearest pixel of the surface; kFarthest: none
    vec3 color;
};

/// Place in the raster of the point of a surface that the pixel would see at the instant,
/// extrapolated from the surface at `at`. The surface ends before it.
vec2 placeOfHiding(PixelSearch pixel, uint instant, vec2 at, Probe hiding) {
    uint mover = findMover(pixel.raster, hiding.key);
    if (mover == kNoMover || isStillMover(pixel.raster, mover)) return pixel.x;
    if (isDeformed(mover)) {
        vec2 displacement;
        float s = timeOf(InstantMotionsRef(method.motions), instant);
        return findDisplacement(kRasterLayer, ivec2(at), s, displacement) ? pixel.x - displacement
                                                                          : pixel.x;
    }
    InstantMotion motion = motionAt(method, kHasLens, pixel.raster, mover, instant);
    if (motion.rasterFromInstant[2] == vec4(0.0f)) return pixel.x;
    float depth = dot(
        motion.instantFromRaster[2],
        pictureSpace(at, depthOfKey(hiding.key, hiding.depth), pixel.perspective)
    );
    PixelRay ray = findRay(motion.rasterFromInstant, pixel.x, pixel.perspective);
    return placeOn(ray, alongOf(depth, pixel.perspective), pixel.perspective);
}

bool showsHidden(PixelSearch pixel, uint key, uint range, Probe hiding, vec2 at) {
    if (!isInside(at)) return false;
    Probe surface = fetchSurface(kRasterLayer, ivec2(at));
    if (key != kStaticKey) return isOf(surface, key, range);
    return isStillMover(pixel.raster, findMover(pixel.raster, surface.key)) &&
           behindSky(surface.key, surface.depth) > hiding.depth;
}

/// Walks from where a surface is hidden towards a place, up to the first pixel that shows the surface. Its
/// color and the one at the end of the way are averaged: each of them is another place's, and the mean of
/// two such guesses errs less than either.
/// \param key of the hidden surface, or kStaticKey
void walkTo(
    PixelSearch pixel, uint key, uint range, vec2 from, vec2 end, Probe hiding, inout Substitute best
) {
    float way = distance(from, end);
    float steps = min(ceil(way), float(kWalkSteps));
    for (float step_ = 1.0f; step_ <= steps; ++step_) {
        float share = step_ / steps;
        vec2 at = mix(from, end, share);
        if (way * share >= best.distancePx || !isInside(at)) return;
        if (!showsHidden(pixel, key, range, hiding, at)) continue;
        vec3 color = fetchColor(kRasterLayer, ivec2(at));
        if (showsHidden(pixel, key, range, hiding, end))
            color = 0.5f * (color + fetchColor(kRasterLayer, ivec2(end)));
        best = Substitute(way * share, color);
        return;
    }
}

/// Walks to the end of the occluder. With a lens, the surface may be visible at the pixel and
/// hidden only from the instant's place of the lens: nearer surfaces count as occluders.
void walkToSeen(
    PixelSearch pixel, uint instant, uint key, uint range, vec2 from, Probe hiding, inout Substitute best
) {
    walkTo(pixel, key, range, from, placeOfHiding(pixel, instant, from, hiding), hiding, best);
    if (kHasLens) walkTo(pixel, key, range, from, pixel.x, hiding, best);
}

/// Depth in the raster of the farthest that the tile may see of an entity.
float farthestInRaster(Candidate candidate, PixelRay ray, bool perspective) {
    if (candidate.key == kSkyKey) return kFarthest;
    float along = alongAt(candidate, 1.0f, perspective);
    float depth = (ray.base + ray.slope * along).z;
    return perspective ? depth / along : depth;
}

/// Considers an entity that the search did not find: it may be hidden where the pixel would see it.
/// If the raster's surface there is farther, the entity is not there at all.
void addHidden(
    PixelSearch pixel, uint instant, Candidate candidate, uint range, inout Substitute best
) {
    InstantMotion motion = motionAt(method, kHasLens, pixel.raster, candidate.mover, instant);
    if (motion.rasterFromInstant[2] == vec4(0.0f)) return;
    PixelRay ray = findRay(motion.rasterFromInstant, pixel.x, pixel.perspective);
    vec2 at = placeOn(ray, alongAt(candidate, 0.5f, pixel.perspective), pixel.perspective);
    at = withinBorder(kRasterLayer, at);
    if (!isInside(at)) return;
    Probe surface = fetchSurface(kRasterLayer, ivec2(at));
    bool isHidden = !isOf(surface, candidate.key, range) &&
                    behindSky(surface.key, surface.depth) <
                        farthestInRaster(candidate, ray, pixel.perspective);
    if (isHidden) walkToSeen(pixel, instant, candidate.key, range, at, surface, best);
}

/// Finds a substitute color for a sample that no layer holds: of the surfaces hidden there in this
/// frame's raster, the one that emerges from behind its occluder at the nearest place. Crowded
/// tiles have no list of such surfaces.
Substitute findSubstitute(PixelSearch pixel, uint instant) {
    if (kHasCrowds && pixel.isCrowded) {
        // Through a lens the tap would add light of what hides the sample.
        if (kHasLens) return Substitute(kFarthest, vec3(0.0f));
        return Substitute(0.0f, fetchOwnTap(pixel, instant));
    }
    Substitute best = Substitute(kFarthest, vec3(0.0f));
    if (pixel.raster.isStatic != 0u) {
        Probe surface = fetchSurface(kRasterLayer, ivec2(pixel.x));
        walkToSeen(pixel, instant, kStaticKey, kAnyRange, pixel.x, surface, best);
    }
    uint slots = getPart(kRasterLayer, pixel.tile, partOf(instant, pixel.partsPerInstant));
    for (; slots != 0u; slots &= slots - 1u) {
        uint slot = uint(findLSB(slots));
        Candidate candidate = getCandidate(kRasterLayer, pixel.tile, slot);
        uint range = getRange(pixel, kRasterLayer, slot);
        if (!isDeformed(candidate.mover)) addHidden(pixel, instant, candidate, range, best);
    }
    return best;
}

#endif
