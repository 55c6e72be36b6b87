// SPDX-License-Identifier: MIT
// The pixel of a thread in a dispatch over a list of blocks. Define SHUTTER_BLOCK_LIST_BINDING, and
// SHUTTER_BLOCK_LIST_ACCESS as nothing where the buffer is written, too.
#ifndef SHUTTER_MOTION_BLUR_BLOCK_LIST_GLSL
#define SHUTTER_MOTION_BLUR_BLOCK_LIST_GLSL

#include "motion_blur/motion_blur_shared.h"

layout(constant_id = 0) const uint kList = kMixedList;

#ifndef SHUTTER_BLOCK_LIST_ACCESS
#define SHUTTER_BLOCK_LIST_ACCESS readonly
#endif

layout(binding = SHUTTER_BLOCK_LIST_BINDING, scalar) SHUTTER_BLOCK_LIST_ACCESS buffer BlockLists {
    BlockHeader header;
    uint entries[];
} uBlocks;

uint countOf(BlockHeader header, uint list) {
    if (list == kUniformList) return header.uniformCount;
    if (list == kMixedList) return header.mixedCount;
    return list == kMaskedList ? header.maskedCount : header.stillCount;
}

/// x | y << 16 of the group's block; false where the dispatch has more groups than the list blocks.
bool findBlock(uvec2 sizePx, out uvec2 block) {
    uint index = gl_WorkGroupID.y * kListRow + gl_WorkGroupID.x;
    block = uvec2(0u);
    if (index >= countOf(uBlocks.header, kList)) return false;
    uvec2 blocks = (sizePx + kGroupSize - 1u) / kGroupSize;
    uint entry = uBlocks.entries[kList * blocks.x * blocks.y + index];
    block = uvec2(entry & 0xFFFFu, entry >> 16);
    return true;
}

/// Whether a block of the candidates has masked pixels; their buffer has a flag for each block of the
/// picture behind the list.
bool isMaskedBlock(uvec2 sizePx, uvec2 block) {
    uvec2 blocks = (sizePx + kGroupSize - 1u) / kGroupSize;
    return uBlocks.entries[blocks.x * blocks.y + block.y * blocks.x + block.x] != 0u;
}

/// The thread's pixel; false where it has none.
bool findPixel(uvec2 sizePx, out ivec2 pixel) {
    uvec2 block;
    pixel = ivec2(0);
    if (!findBlock(sizePx, block)) return false;
    pixel = ivec2(block * kGroupSize + gl_LocalInvocationID.xy);
    return all(lessThan(uvec2(pixel), sizePx));
}

#endif
