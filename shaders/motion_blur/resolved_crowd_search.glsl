// SPDX-License-Identifier: MIT
// The search in crowded tiles, which have no complete list of candidates. It is not bound to an
// entity: from each seed it converges to any surface of the layer that is at the pixel at the
// instant. Part of resolved_search.glsl.
#ifndef SHUTTER_RESOLVED_CROWD_SEARCH_GLSL
#define SHUTTER_RESOLVED_CROWD_SEARCH_GLSL

#include "motion_blur/resolved_crowds.glsl"

/// Where something that a layer shows is at an instant.
struct Displaced {
    bool isKnown;
    vec2 place;
    float depth;
};

Displaced displace(
    uint index, LayerMotion layer, PixelSearch pixel, Probe surface, vec2 at, uint instant
) {
    Displaced unknown = Displaced(false, at, 0.0f);
    uint mover = findMover(layer, surface.key);
    if (mover == kNoMover) return unknown;
    if (isStillMover(layer, mover)) return Displaced(true, at, surface.depth);
    if (isDeformed(mover)) {
        if (!has(method, kHasWays) && index != kRasterLayer) return unknown;
        vec2 displacement;
        float s = timeOf(InstantMotionsRef(method.motions), instant);
        bool isKnown = findDisplacement(index, ivec2(at), s, displacement);
        if (kHasLens)
            displacement +=
                lensShift(lensOf(InstantMotionsRef(method.motions), instant), surface.depth);
        return Displaced(isKnown, at + displacement, surface.depth);
    }
    InstantMotion motion = motionAt(method, kHasLens, layer, mover, instant);
    if (motion.instantFromRaster[2] == vec4(0.0f)) return unknown;
    float depth = depthOfKey(surface.key, surface.depth);
    vec3 seen =
        transformRows(motion.instantFromRaster, pictureSpace(at, depth, pixel.perspective));
    if (pixel.perspective && seen.z < kMinDepth) return unknown;
    return Displaced(true, projectPicture(seen, pixel.perspective), seen.z);
}

void searchFrom(
    uint index, LayerMotion layer, PixelSearch pixel, uint instant, vec2 at, inout Seen best
) {
    for (uint step_ = 0u; step_ < kSteps; ++step_) {
        if (!isInside(at)) return;
        Probe surface = fetchSurface(index, ivec2(at));
        Displaced displaced = displace(index, layer, pixel, surface, at, instant);
        if (!displaced.isKnown) return;
        vec2 way = pixel.x - displaced.place;
        float distancePx = length(way);
        vec2 next = at + way;
        if (distancePx > kArrivedPx && step_ + 1u < kSteps) {
            at = next;
            continue;
        }
        if (distancePx > kTolerancePx || !isInside(next)) return;
        if (fetchSurface(index, ivec2(next)).key != surface.key) return;
        // Among many small entities, colours next to edges are interpolated as elsewhere.
        float depth = behindSky(surface.key, displaced.depth);
        keepNearer(best, Seen(true, index, surface.key, next, depth, true, kAnyRange), pixel.x);
        return;
    }
}

void searchCrowd(
    uint index, LayerMotion layer, PixelSearch pixel, uint instant, inout Seen best
) {
    searchFrom(index, layer, pixel, instant, pixel.x, best);
    uvec2 tiles = countTiles(params.sizePx);
    TileCrowd crowd = CrowdTable(method.crowds).tiles[index * tiles.x * tiles.y + pixel.tile];
    for (uint slot = 0u; slot < kCrowdSeeds; ++slot) {
        uint seed = crowd.seeds[slot];
        if (seed == kNoSeed) continue;
        vec2 at = vec2(seed & 0xFFFFu, seed >> 16) + 0.5f;
        Probe surface = fetchSurface(index, ivec2(at));
        Displaced displaced = displace(index, layer, pixel, surface, at, instant);
        if (!displaced.isKnown) continue;
        searchFrom(index, layer, pixel, instant, pixel.x - (displaced.place - at), best);
    }
}

/// Finds the sample of a pixel in a crowded tile.
Seen searchCrowds(PixelSearch pixel, uint instant) {
    Seen seen = pixel.still;
    searchCrowd(kRasterLayer, pixel.raster, pixel, instant, seen);
    if (kHasSecond && !seen.isFound) {
        seen = pixel.secondStill;
        searchCrowd(kSecondLayer, pixel.second, pixel, instant, seen);
    }
    if (!seen.isFound && has(method, kHasLastLayer)) {
        seen = pixel.lastStill;
        searchCrowd(kLastLayer, pixel.last, pixel, instant, seen);
    }
    return seen;
}

/// Fallback for an unknown sample: the tap of `own_velocity`.
vec3 fetchOwnTap(PixelSearch pixel, uint instant) {
    InstantMotionsRef motions = InstantMotionsRef(method.motions);
    float time = timeOf(motions, instant) - params.rasterTime;
    vec3 motionDepth = textureLod(uMotionDepth, uvOf(pixel.x), 0.0f).xyz;
    vec2 displacement = motionDepth.xy * time;
    if (kHasLens) displacement += lensShift(lensOf(motions, instant), motionDepth.z);
    return fetchColor(kRasterLayer, keepInside(ivec2(floor(pixel.x - displacement))));
}

#endif
