// SPDX-License-Identifier: MIT
// Screen boxes of a surface at several instants, and the tiles that they overlap. The including
// shader has the push constants `params` and `method`.
#ifndef SHUTTER_RESOLVED_BOXES_GLSL
#define SHUTTER_RESOLVED_BOXES_GLSL

#include "motion_blur/resolved.glsl"

/// Where an entity is seen at some instants, with the margin around it.
struct SeenBox {
    vec2 low;
    vec2 high;
    vec2 depths;
    uint parts; // of the exposure, a bit each; 0: it is not seen
};

const SeenBox kNoBox = SeenBox(vec2(3.0e38f), vec2(-3.0e38f), vec2(3.0e38f, 0.0f), 0u);

/// \param low, high including the margin
void addBox(uint instant, vec2 low, vec2 high, vec2 depths, inout SeenBox box) {
    if (any(lessThan(high, vec2(0.0f))) || any(greaterThan(low, vec2(params.sizePx)))) return;
    box.low = min(box.low, low);
    box.high = max(box.high, high);
    box.depths = vec2(min(box.depths.x, depths.x), max(box.depths.y, depths.y));
    box.parts |= 1u << partOf(instant, partsPerInstant(method));
}

/// From where the pinhole in the lens's middle sees something to where the instant's place of it does.
void widenByLens(uint instant, vec2 depths, inout vec2 low, inout vec2 high) {
    if (!has(method, kHasLensPlaces)) return;
    vec4 lens = lensOf(InstantMotionsRef(method.motions), instant);
    vec2 nearest = lensShift(lens, depths.x);
    vec2 farthest = lensShift(lens, depths.y);
    low += min(nearest, farthest);
    high += max(nearest, farthest);
}

/// Tiles that a box reaches, the last ones included.
struct TileRange {
    uvec2 from;
    uvec2 to;
};

TileRange findTiles(SeenBox box) {
    vec2 size = vec2(params.sizePx);
    uvec2 last = countTiles(params.sizePx) - 1u;
    vec2 low = clamp(box.low, vec2(0.0f), size - 1.0f) / float(kCandidateTilePx);
    vec2 high = clamp(box.high, vec2(0.0f), size - 1.0f) / float(kCandidateTilePx);
    return TileRange(min(uvec2(low), last), min(uvec2(high), last));
}

#endif
