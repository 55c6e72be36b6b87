// SPDX-License-Identifier: MIT
// Enters what is seen at some instants in the lists of the tiles that it is seen in. Whoever includes
// this has the push constants `params` and `method`.
#ifndef SHUTTER_RESOLVED_ENTER_GLSL
#define SHUTTER_RESOLVED_ENTER_GLSL

#include "motion_blur/resolved.glsl"

layout(binding = 2, scalar) buffer Candidates { TileCandidates uTiles[]; };
layout(binding = 3, scalar) buffer Counters { ResolvedCounters uCounters; };

uvec2 countTiles() { return (params.sizePx + kCandidateTilePx - 1u) / kCandidateTilePx; }

void enter(uint tile, uint key, vec2 depths, uint bits) {
    for (uint slot = 0u; slot < kCandidatesPerTile; ++slot) {
        uint held = uTiles[tile].candidates[slot].key;
        if (held == kNoKey) held = atomicCompSwap(uTiles[tile].candidates[slot].key, kNoKey, key);
        if (held != kNoKey && held != key) continue;
        atomicMin(uTiles[tile].candidates[slot].nearest, floatBitsToUint(max(depths.x, 0.0f)));
        atomicMin(
            uTiles[tile].candidates[slot].farthestInverted, ~floatBitsToUint(max(depths.y, 0.0f))
        );
        atomicAnd(uTiles[tile].parts[slot], ~bits);
        return;
    }
    atomicAdd(uCounters.overflown, 1u);
}

/// Where an entity is seen at some instants, with the margin around it.
struct SeenBox {
    vec2 low;
    vec2 high;
    vec2 depths;
    uint parts; // of the exposure, a bit each; 0: it is not seen
};

const SeenBox kNoBox = SeenBox(vec2(3.0e38f), vec2(-3.0e38f), vec2(3.0e38f, 0.0f), 0u);

/// \param low, high with the margin around what is seen
void addBox(uint instant, vec2 low, vec2 high, vec2 depths, inout SeenBox box) {
    if (any(lessThan(high, vec2(0.0f))) || any(greaterThan(low, vec2(params.sizePx)))) return;
    box.low = min(box.low, low);
    box.high = max(box.high, high);
    box.depths = vec2(min(box.depths.x, depths.x), max(box.depths.y, depths.y));
    box.parts |= 1u << partOf(instant, partsPerInstant(method.instantCount));
}

void enterBox(uint key, SeenBox box) {
    vec2 size = vec2(params.sizePx);
    uvec2 tiles = countTiles();
    vec2 lowTile = clamp(box.low, vec2(0.0f), size - 1.0f) / float(kCandidateTilePx);
    vec2 highTile = clamp(box.high, vec2(0.0f), size - 1.0f) / float(kCandidateTilePx);
    uvec2 from = min(uvec2(lowTile), tiles - 1u);
    uvec2 to = min(uvec2(highTile), tiles - 1u);
    for (uint y = from.y; y <= to.y; ++y)
        for (uint x = from.x; x <= to.x; ++x) enter(y * tiles.x + x, key, box.depths, box.parts);
}

#endif
