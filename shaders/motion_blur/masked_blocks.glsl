// SPDX-License-Identifier: MIT
// Lists blocks with masked pixels, and flags them among the candidates. Before it: `params`, buffers uSorted
// and uLists, and block_list.glsl over the candidates with its flags for writing.
#ifndef SHUTTER_MOTION_BLUR_MASKED_BLOCKS_GLSL
#define SHUTTER_MOTION_BLUR_MASKED_BLOCKS_GLSL

uint countBlocks() {
    uvec2 blocks = (params.sizePx + kGroupSize - 1u) / kGroupSize;
    return blocks.x * blocks.y;
}

/// Where a block's flag lies behind the list of candidates.
uint flagOf(uvec2 block) {
    uint row = (params.sizePx.x + kGroupSize - 1u) / kGroupSize;
    return countBlocks() + block.y * row + block.x;
}

/// Lists a block with masked pixels.
/// \return whether it was not yet in the list
bool listBlock(uvec2 block) {
    if (atomicExchange(uBlocks.entries[flagOf(block)], 1u) != 0u) return false;
    uint blockCount = countBlocks();
    uint index = atomicAdd(uSorted.header.maskedCount, 1u);
    uSorted.entries[kMaskedList * blockCount + index] = block.x | block.y << 16;
    if (index < kListRow) atomicMax(uLists[kMaskedList].groupsX, index + 1u);
    if (index % kListRow == 0u) atomicAdd(uLists[kMaskedList].groupsY, 1u);
    return true;
}

#endif
