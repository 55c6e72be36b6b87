// SPDX-License-Identifier: MIT
// Sorts the picture's blocks into lists by what they need. A thread per block. A block has the most
// demanding class of the tiles that its pixels look up, unless no smear reaches it.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "motion_blur/block_class.glsl"

layout(constant_id = 0) const uint kForMask = 0u; // 1: blocks that may be masked become candidates
layout(constant_id = 1) const bool kListsStill = false; // else still blocks are in no list

layout(local_size_x = kGroupSize, local_size_y = kGroupSize) in;
layout(push_constant, scalar) uniform Push { MotionBlurParams params; };
layout(binding = 0) uniform sampler2D uTiles;
layout(binding = 1) uniform sampler2D uTileClass;
layout(binding = 2, scalar) buffer BlockLists {
    BlockHeader header;
    uint entries[];
} uBlocks;
layout(binding = 3, scalar) buffer Arguments { DispatchArguments uArguments[kListCount]; };
layout(binding = 4, scalar) buffer Candidates {
    BlockHeader header;
    uint entries[];
} uCandidates;
layout(binding = 5, scalar) buffer CandidateArguments { DispatchArguments uCandidateArguments; };

vec2 uvOf(ivec2 tile) { return (vec2(tile) + 0.5f) / vec2(params.tileCount); }

/// A tile that is farther than the next one never reaches a block: motion is no longer than a tile.
bool isReached(vec2 first, vec2 end) {
    int ring = min(params.neighbourRadius, 1);
    // Pixels may look up tiles beyond their own by a margin, and gather their reach.
    ivec2 lowest = lowestTile(first, params.marginPx, params.tileSizePx, params.tileCount);
    ivec2 highest = highestTile(end, params.marginPx, params.tileSizePx, params.tileCount);
    lowest = max(lowest - ring, ivec2(0));
    highest = min(highest + ring, ivec2(params.tileCount) - 1);
    float tileSize = float(params.tileSizePx);
    for (int y = lowest.y; y <= highest.y; ++y)
        for (int x = lowest.x; x <= highest.x; ++x) {
            float speed = length(textureLod(uTiles, uvOf(ivec2(x, y)), 0.0f).xy);
            vec2 tileFirst = vec2(x, y) * tileSize;
            if (speed >= kStillPx &&
                reachesBlock(first, end, tileFirst, tileFirst + tileSize, speed + params.marginPx))
                return true;
        }
    return false;
}

float classifyBlock(vec2 first, vec2 end) {
    ivec2 lowest = lowestTile(first, params.marginPx, params.tileSizePx, params.tileCount);
    ivec2 highest = highestTile(end, params.marginPx, params.tileSizePx, params.tileCount);
    float demand = kClassStill;
    for (int y = lowest.y; y <= highest.y; ++y)
        for (int x = lowest.x; x <= highest.x; ++x)
            demand = max(demand, textureLod(uTileClass, uvOf(ivec2(x, y)), 0.0f).x);
    return demand > kClassStill && isReached(first, end) ? demand : kClassStill;
}

/// \param index of the entry in the list
void writeEntry(uint list, uint index, uvec2 block, uvec2 blocks) {
    uBlocks.entries[list * blocks.x * blocks.y + index] = block.x | block.y << 16;
    // Both dimensions of a dispatch follow the list as it grows: no pass is needed to add them up.
    atomicMax(uArguments[list].groupsX, min(index + 1u, kListRow));
    if (index % kListRow == 0u) atomicAdd(uArguments[list].groupsY, 1u);
}

void main() {
    uvec2 block = gl_GlobalInvocationID.xy;
    uvec2 blocks = (params.sizePx + kGroupSize - 1u) / kGroupSize;
    if (any(greaterThanEqual(block, blocks))) return;
    vec2 first = vec2(block * kGroupSize);
    vec2 end = min(first + float(kGroupSize), vec2(params.sizePx));
    float demand = classifyBlock(first, end);
    if (demand == kClassStill) {
        if (kListsStill)
            writeEntry(kStillList, atomicAdd(uBlocks.header.stillCount, 1u), block, blocks);
    } else if (kForMask != 0u && demand == kClassDeep) {
        uint index = atomicAdd(uCandidates.header.uniformCount, 1u);
        uCandidates.entries[index] = block.x | block.y << 16;
        atomicMax(uCandidateArguments.groupsX, min(index + 1u, kListRow));
        if (index % kListRow == 0u) atomicAdd(uCandidateArguments.groupsY, 1u);
    } else if (demand == kClassUniform) {
        writeEntry(kUniformList, atomicAdd(uBlocks.header.uniformCount, 1u), block, blocks);
    } else {
        writeEntry(kMixedList, atomicAdd(uBlocks.header.mixedCount, 1u), block, blocks);
    }
}
