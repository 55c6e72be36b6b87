// SPDX-License-Identifier: MIT
// Lists masked pixels for the reveal. Before it: `params`, isMasked(pixel), markBlock(block) for a block
// with masked pixels, picture uMask, and buffers uMasked and uReveal.
#ifndef SHUTTER_MOTION_BLUR_MASK_LIST_GLSL
#define SHUTTER_MOTION_BLUR_MASK_LIST_GLSL

#include "motion_blur/mask_bits.glsl"
#include "motion_blur/ray_share.glsl"

/// 1: a group appends its pixels together, with two barriers and a few global atomics per block; 0:
/// each masked pixel appends itself, with a few atomics. On a CPU device, barriers cost more than
/// atomics, on a GPU less.
layout(constant_id = 1) const uint kListTogether = 0u;

/// Place in the list for `count` pixels, for which the reveal gets groups.
uint takePlaces(uint count) {
    uint first = atomicAdd(uMasked.header.listedPixels, count);
    uint group = (first + count - 1u) / kRevealThreads;
    // The groups of a full row are as many as they can be: most pixels leave the word alone.
    if (first / kRevealThreads < kListRow)
        atomicMax(uReveal.groupsX, min(group + 1u, kListRow));
    uint perRow = kRevealThreads * kListRow;
    uint rows = countRows(first + count, perRow) - countRows(first, perRow);
    if (rows > 0u) atomicAdd(uReveal.groupsY, rows);
    return first;
}

void storeEntry(uint index, ivec2 pixel, bool quads) {
    uMasked.pixels[index] = uint(pixel.x) | uint(pixel.y) << 16 | (quads ? kQuadFlag : 0u);
}

/// Whether no pixel of its quad before it is masked. Those are worked out once more, which costs less
/// than threads that wait for each other.
bool leadsQuad(ivec2 pixel) {
    ivec2 first = pixel & ~1;
    int own = (pixel.x & 1) + (pixel.y & 1) * 2;
    for (int i = 0; i < own; ++i)
        if (isMasked(first + ivec2(i & 1, i >> 1))) return false;
    return true;
}

/// In a quad the first masked pixel traces for all.
void listPixel(ivec2 pixel, bool quads) {
    markBlock(uvec2(pixel) / kGroupSize);
    if (quads && !leadsQuad(pixel)) {
        atomicAdd(uMasked.header.sharingPixels, 1u);
        return;
    }
    storeEntry(takePlaces(1u), pixel, quads);
}

shared uint sMasked[2]; // mask_bits.glsl
shared uint sFirst;     // place of the group's first pixel

/// For all threads of a group, masked or not; they come here together.
void listTogether(ivec2 pixel, bool masked, bool quads) {
    uint thread = gl_LocalInvocationIndex;
    if (thread < 2u) sMasked[thread] = 0u;
    barrier();
    if (masked) atomicOr(sMasked[thread / 32u], 1u << (thread % 32u));
    barrier();
    uvec2 maskedBits = uvec2(sMasked[0], sMasked[1]);
    uint maskedCount = countBits(maskedBits);
    if (maskedCount == 0u) return;
    uvec2 listed = listedBits(maskedBits, quads);
    uint listedCount = countBits(listed);
    if (thread == 0u) {
        markBlock(uvec2(pixel) / kGroupSize);
        sFirst = takePlaces(listedCount);
        if (maskedCount > listedCount)
            atomicAdd(uMasked.header.sharingPixels, maskedCount - listedCount);
    }
    barrier();
    if (hasBit(listed, thread)) storeEntry(sFirst + countBitsBefore(listed, thread), pixel, quads);
}

/// For all threads of a group where they list together, in the picture or not.
void listMasked(ivec2 pixel, bool isInside, float rayShare) {
    uint tracing = chooseTracing(vec2(uvec2(pixel) / kGroupSize), rayShare);
    bool quads = tracing == kTraceQuads;
    bool masked = isInside && tracing != kTraceNothing && isMasked(pixel);
    if (masked) imageStore(uMask, pixel, vec4(1.0f));
    if (kListTogether != 0u)
        listTogether(pixel, masked, quads);
    else if (masked)
        listPixel(pixel, quads);
}

#endif
