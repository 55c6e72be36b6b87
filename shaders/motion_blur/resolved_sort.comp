// SPDX-License-Identifier: MIT
// Sorts each tile's candidates, nearest first. A thread per tile.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "motion_blur/resolved.glsl"
#include "motion_blur/resolved_parts_shared.h"

layout(local_size_x = kGroupSize, local_size_y = kGroupSize) in;
layout(push_constant, scalar) uniform Push {
    MotionBlurParams params;
    ResolvedParams method;
};
layout(binding = 0, scalar) buffer RasterCandidates { TileCandidates uRaster[]; };
layout(binding = 1, scalar) buffer LastCandidates { TileCandidates uLast[]; };
layout(binding = 2, scalar) buffer SecondCandidates { TileCandidates uSecond[]; };

Candidate getCandidate(uint layer, uint tile, uint slot) {
    if (layer == kLastLayer) return uLast[tile].candidates[slot];
    if (layer == kSecondLayer) return uSecond[tile].candidates[slot];
    return uRaster[tile].candidates[slot];
}

void setCandidate(uint layer, uint tile, uint slot, Candidate candidate) {
    if (layer == kLastLayer)
        uLast[tile].candidates[slot] = candidate;
    else if (layer == kSecondLayer)
        uSecond[tile].candidates[slot] = candidate;
    else
        uRaster[tile].candidates[slot] = candidate;
}

uint getParts(uint layer, uint tile, uint index) {
    if (layer == kLastLayer) return uLast[tile].parts[index];
    if (layer == kSecondLayer) return uSecond[tile].parts[index];
    return uRaster[tile].parts[index];
}

void setParts(uint layer, uint tile, uint index, uint bits) {
    if (layer == kLastLayer)
        uLast[tile].parts[index] = bits;
    else if (layer == kSecondLayer)
        uSecond[tile].parts[index] = bits;
    else
        uRaster[tile].parts[index] = bits;
}

/// In the order of searching: the sky is behind everything, and equals have one order.
bool isBefore(Candidate a, Candidate b) {
    uint depthA = a.key == kSkyKey ? kNoKey : a.nearest;
    uint depthB = b.key == kSkyKey ? kNoKey : b.nearest;
    return depthA < depthB || (depthA == depthB && a.key < b.key);
}

/// \return how many there are
uint sortCandidates(uint layer, uint tile) {
    LayerMotion motion = getLayer(InstantMotionsRef(method.motions), layer);
    uint end = 0u;
    for (; end < kCandidatesPerTile; ++end) {
        Candidate moved = getCandidate(layer, tile, end);
        if (moved.key == kNoKey) break;
        moved.mover =
            (moved.key & kPartBit) != 0u ? kDeformedMover : findMover(motion, moved.key);
        uint parts = getParts(layer, tile, end);
        uint slot = end;
        for (; slot > 0u; --slot) {
            Candidate before = getCandidate(layer, tile, slot - 1u);
            if (!isBefore(moved, before)) break;
            setCandidate(layer, tile, slot, before);
            setParts(layer, tile, slot, getParts(layer, tile, slot - 1u));
        }
        setCandidate(layer, tile, slot, moved);
        setParts(layer, tile, slot, parts);
    }
    return end;
}

/// From a bit for each part, by candidate, to a bit for each candidate, by part.
void transposeParts(uint layer, uint tile, uint count) {
    uint missing[kCandidatesPerTile];
    for (uint slot = 0u; slot < count; ++slot) missing[slot] = getParts(layer, tile, slot);
    for (uint part = 0u; part < min(method.instantCount, kExposureParts); ++part) {
        uint bits = 0u;
        for (uint slot = 0u; slot < count; ++slot) bits |= (~missing[slot] >> part & 1u) << slot;
        setParts(layer, tile, part, bits);
    }
}

void prepareTile(uint layer, uint tile) { transposeParts(layer, tile, sortCandidates(layer, tile)); }

void main() {
    uvec2 tile = gl_GlobalInvocationID.xy;
    uvec2 tiles = countTiles(params.sizePx);
    if (any(greaterThanEqual(tile, tiles))) return;
    uint index = tile.y * tiles.x + tile.x;
    prepareTile(kRasterLayer, index);
    if (has(method, kHasLastLayer)) prepareTile(kLastLayer, index);
    if (has(method, kHasSecondLayer)) prepareTile(kSecondLayer, index);
}
