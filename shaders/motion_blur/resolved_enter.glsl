// SPDX-License-Identifier: MIT
// Enters candidates into the lists of the tiles in which they are visible at some instants. The
// including shader has the push constants `params` and `method`.
#ifndef SHUTTER_RESOLVED_ENTER_GLSL
#define SHUTTER_RESOLVED_ENTER_GLSL

#extension GL_EXT_control_flow_attributes : require

#include "motion_blur/resolved_boxes.glsl"
#include "motion_blur/resolved_crowds.glsl"

layout(binding = 2, scalar) buffer Candidates { TileCandidates uTiles[]; };
layout(binding = 3, scalar) buffer CrowdArguments { DispatchArguments uCrowdArguments; };

/// No list holds all that the tile sees.
/// \param bits of TileCrowd::listed
void noteCrowd(uint tile, uint bits) {
    if (!mayHaveCrowds()) return;
    noteUnlisted(tile, bits);
    atomicMax(uCrowdArguments.groupsX, countTiles(params.sizePx).x);
    atomicMax(uCrowdArguments.groupsY, countTiles(params.sizePx).y);
    atomicMax(uCrowdArguments.groupsZ, countLayers());
}

/// Marks that the layer has more entities in the tile than can be listed, so that they are in no
/// list.
void noteUnlistedSource(uint tile, uint layer) {
    noteCrowd(tile, kSourceIsListed << layer | (layer == kRasterLayer ? kTileIsListed : 0u));
}

/// \param bits of parts of the exposure, and of parallax bins
void enter(uint tile, uint key, vec2 depths, uint bits, uvec2 bins) {
    [[dont_unroll]] for (uint slot = 0u; slot < kCandidatesPerTile; ++slot) {
        uint held = uTiles[tile].candidates[slot].key;
        if (held == kNoKey) held = atomicCompSwap(uTiles[tile].candidates[slot].key, kNoKey, key);
        if (held != kNoKey && held != key) continue;
        // Atomics are slow where threads wait for each other, and most would change nothing.
        uint nearest = floatBitsToUint(max(depths.x, 0.0f));
        uint farthestInverted = ~floatBitsToUint(max(depths.y, 0.0f));
        if (uTiles[tile].candidates[slot].nearest > nearest)
            atomicMin(uTiles[tile].candidates[slot].nearest, nearest);
        if (uTiles[tile].candidates[slot].farthestInverted > farthestInverted)
            atomicMin(uTiles[tile].candidates[slot].farthestInverted, farthestInverted);
        if ((uTiles[tile].parts[slot] & bits) != 0u) atomicAnd(uTiles[tile].parts[slot], ~bits);
        if (bins == uvec2(0u)) return;
        for (uint word = 0u; word < 2u; ++word)
            if ((uTiles[tile].ranges[2u * slot + word] & bins[word]) != 0u)
                atomicAnd(uTiles[tile].ranges[2u * slot + word], ~bins[word]);
        return;
    }
    noteCrowd(tile, kTileIsListed);
}

void enterBox(uint key, SeenBox box, uvec2 bins) {
    TileRange range = findTiles(box);
    uint across = countTiles(params.sizePx).x;
    for (uint y = range.from.y; y <= range.to.y; ++y)
        for (uint x = range.from.x; x <= range.to.x; ++x)
            enter(y * across + x, key, box.depths, box.parts, bins);
}

#endif
