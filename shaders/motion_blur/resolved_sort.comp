// SPDX-License-Identifier: MIT
// Sorts each tile's candidates, nearest first. A thread per tile.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : require
#include "motion_blur/resolved.glsl"
#include "motion_blur/resolved_parts_shared.h"

/// So many tiles' candidates fill 16 KiB, the shared memory that every device has.
const uint kThreadRows = 4u;
const uint kThreads = kGroupSize * kThreadRows;

layout(local_size_x = kGroupSize, local_size_y = kThreadRows) in;
layout(push_constant, scalar) uniform Push {
    MotionBlurParams params;
    ResolvedParams method;
};
layout(binding = 0, scalar) buffer RasterCandidates { TileCandidates uRaster[]; };
layout(binding = 1, scalar) buffer LastCandidates { TileCandidates uLast[]; };
layout(binding = 2, scalar) buffer SecondCandidates { TileCandidates uSecond[]; };

/// A tile's candidates while they are sorted, by slot and thread: device memory is slow to reach.
shared uint sKeys[kCandidatesPerTile][kThreads];
shared uint sNearest[kCandidatesPerTile][kThreads];
shared uint sFarthestInverted[kCandidatesPerTile][kThreads];
shared uint sParts[kCandidatesPerTile][kThreads];

Candidate readCandidate(uint layer, uint tile, uint slot) {
    if (layer == kLastLayer) return uLast[tile].candidates[slot];
    if (layer == kSecondLayer) return uSecond[tile].candidates[slot];
    return uRaster[tile].candidates[slot];
}

void writeCandidate(uint layer, uint tile, uint slot, Candidate candidate) {
    if (layer == kLastLayer)
        uLast[tile].candidates[slot] = candidate;
    else if (layer == kSecondLayer)
        uSecond[tile].candidates[slot] = candidate;
    else
        uRaster[tile].candidates[slot] = candidate;
}

uint readParts(uint layer, uint tile, uint index) {
    if (layer == kLastLayer) return uLast[tile].parts[index];
    if (layer == kSecondLayer) return uSecond[tile].parts[index];
    return uRaster[tile].parts[index];
}

void writeParts(uint layer, uint tile, uint index, uint bits) {
    if (layer == kLastLayer)
        uLast[tile].parts[index] = bits;
    else if (layer == kSecondLayer)
        uSecond[tile].parts[index] = bits;
    else
        uRaster[tile].parts[index] = bits;
}

/// What candidates are sorted by: the sky is behind everything, and equals have one order.
uvec2 rankOf(uint key, uint nearest) { return uvec2(key == kSkyKey ? kNoKey : nearest, key); }

bool isBefore(uvec2 a, uvec2 b) { return a.x < b.x || (a.x == b.x && a.y < b.y); }

/// \return how many there are
uint sortCandidates(uint layer, uint tile, uint thread) {
    uint end = 0u;
    [[dont_unroll]] for (; end < kCandidatesPerTile; ++end) {
        Candidate moved = readCandidate(layer, tile, end);
        if (moved.key == kNoKey) break;
        uvec2 rank = rankOf(moved.key, moved.nearest);
        uint slot = end;
        [[dont_unroll]] for (; slot > 0u; --slot) {
            if (!isBefore(rank, rankOf(sKeys[slot - 1u][thread], sNearest[slot - 1u][thread]))) break;
            sKeys[slot][thread] = sKeys[slot - 1u][thread];
            sNearest[slot][thread] = sNearest[slot - 1u][thread];
            sFarthestInverted[slot][thread] = sFarthestInverted[slot - 1u][thread];
            sParts[slot][thread] = sParts[slot - 1u][thread];
        }
        sKeys[slot][thread] = moved.key;
        sNearest[slot][thread] = moved.nearest;
        sFarthestInverted[slot][thread] = moved.farthestInverted;
        sParts[slot][thread] = readParts(layer, tile, end);
    }
    return end;
}

void writeCandidates(uint layer, uint tile, uint count, uint thread) {
    LayerMotion motion = getLayer(InstantMotionsRef(method.motions), layer);
    [[dont_unroll]] for (uint slot = 0u; slot < count; ++slot) {
        uint key = sKeys[slot][thread];
        uint mover = (key & kPartBit) != 0u ? kDeformedMover : findMover(motion, key);
        writeCandidate(
            layer, tile, slot,
            Candidate(key, sNearest[slot][thread], sFarthestInverted[slot][thread], mover)
        );
    }
}

/// From a bit for each part, by candidate, to a bit for each candidate, by part.
void transposeParts(uint layer, uint tile, uint count, uint thread) {
    [[dont_unroll]] for (uint part = 0u; part < min(method.instantCount, kExposureParts); ++part) {
        uint bits = 0u;
        [[dont_unroll]] for (uint slot = 0u; slot < count; ++slot)
            bits |= (~sParts[slot][thread] >> part & 1u) << slot;
        writeParts(layer, tile, part, bits);
    }
}

void prepareTile(uint layer, uint tile) {
    uint thread = gl_LocalInvocationIndex;
    uint count = sortCandidates(layer, tile, thread);
    writeCandidates(layer, tile, count, thread);
    transposeParts(layer, tile, count, thread);
}

void main() {
    uvec2 tile = gl_GlobalInvocationID.xy;
    uvec2 tiles = countTiles(params.sizePx);
    if (any(greaterThanEqual(tile, tiles))) return;
    uint index = tile.y * tiles.x + tile.x;
    prepareTile(kRasterLayer, index);
    if (has(method, kHasLastLayer)) prepareTile(kLastLayer, index);
    if (has(method, kHasSecondLayer)) prepareTile(kSecondLayer, index);
}
