// SPDX-License-Identifier: MIT
// Lists the picture's blocks that something moves in: those whose tile has a candidate. A thread a
// block.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "motion_blur/resolved.glsl"

layout(local_size_x = kGroupSize, local_size_y = kGroupSize) in;
layout(push_constant, scalar) uniform Push {
    MotionBlurParams params;
    ResolvedParams method;
};
layout(binding = 0, scalar) readonly buffer RasterCandidates { Candidate uRaster[]; };
layout(binding = 1, scalar) readonly buffer LastCandidates { Candidate uLast[]; };
layout(binding = 2, scalar) buffer BlockLists {
    BlockHeader header;
    uint entries[];
} uBlocks;
layout(binding = 3, scalar) buffer Arguments { DispatchArguments uArguments[kListCount]; };

void main() {
    uvec2 block = gl_GlobalInvocationID.xy;
    uvec2 blocks = (params.sizePx + kGroupSize - 1u) / kGroupSize;
    if (any(greaterThanEqual(block, blocks))) return;
    uvec2 tiles = (params.sizePx + kCandidateTilePx - 1u) / kCandidateTilePx;
    uvec2 tile = block * kGroupSize / kCandidateTilePx;
    uint first = (tile.y * tiles.x + tile.x) * kCandidatesPerTile;
    bool moves = uRaster[first].key != kNoKey;
    if (method.hasLast != 0u) moves = moves || uLast[first].key != kNoKey;
    if (!moves) return;
    uint index = atomicAdd(uBlocks.header.mixedCount, 1u);
    uBlocks.entries[kMixedList * blocks.x * blocks.y + index] = block.x | block.y << 16;
    atomicMax(uArguments[kMixedList].groupsX, min(index + 1u, kListRow));
    if (index % kListRow == 0u) atomicAdd(uArguments[kMixedList].groupsY, 1u);
}
