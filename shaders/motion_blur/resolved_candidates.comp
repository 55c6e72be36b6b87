// SPDX-License-Identifier: MIT
// Which entities of a layer each tile of the picture may see during the exposure, and between which
// depths. A group takes a tile of the layer: it lists the entities in it with their extents, then
// finds for each and each instant where that box is seen, and enters it in the lists of the tiles
// there.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_scalar_block_layout : require
#include "motion_blur/pixel_ray.glsl"
#include "motion_blur/resolved.glsl"
#include "motion_blur/resolved_parts_shared.h"

layout(constant_id = 0) const uint kLayer = kRasterLayer;

// Each thread takes several of the tile's pixels: on software devices a thread that waits at a barrier
// is expensive.
layout(local_size_x = kGroupSize, local_size_y_id = 1) in;
layout(constant_id = 2) const uint kThreadRows = kGroupSize; // of a group
layout(constant_id = 3) const bool kHasEdges = false; // pixels may show two surfaces
layout(push_constant, scalar) uniform Push {
    MotionBlurParams params;
    ResolvedParams method;
};
layout(binding = 0) uniform usampler2D uSurface;
layout(binding = 1, scalar) buffer DeformingArguments { DispatchArguments uDeformingArguments; };
layout(binding = 4, scalar) buffer DeformingTiles {
    DeformingHeader header;
    uint entries[];
} uDeforming;

layout(binding = 5) uniform usampler2D uEdgeSurface; // with kHasEdges

#include "motion_blur/resolved_enter.glsl"
#include "motion_blur/resolved_extents.glsl"

// Results of the group in its tile.
shared uint sKeys[kCandidatesPerTile];
shared uint sNearest[kCandidatesPerTile];
shared uint sFarthest[kCandidatesPerTile];
shared uint sBins[2][kCandidatesPerTile];
shared int sLowX[kCandidatesPerTile];
shared int sLowY[kCandidatesPerTile];
shared int sHighX[kCandidatesPerTile];
shared int sHighY[kCandidatesPerTile];
shared uint sDeforms; // 1: something in it does
shared uint sIsFull;  // 1: there are more

void note(uint slot, Extent extent) {
    atomicMin(sNearest[slot], floatBitsToUint(extent.depths.x));
    atomicMax(sFarthest[slot], floatBitsToUint(extent.depths.y));
    if (extent.bins.x != 0u) atomicOr(sBins[0][slot], extent.bins.x);
    if (extent.bins.y != 0u) atomicOr(sBins[1][slot], extent.bins.y);
    atomicMin(sLowX[slot], extent.low.x);
    atomicMin(sLowY[slot], extent.low.y);
    atomicMax(sHighX[slot], extent.high.x);
    atomicMax(sHighY[slot], extent.high.y);
}

void listExtent(Extent extent) {
    if (!extent.isOfUse) return;
    // Unrolled, within the loops over pixels, it takes compilers half a minute.
    [[dont_unroll]] for (uint slot = 0u; slot < kCandidatesPerTile; ++slot) {
        uint held = sKeys[slot];
        if (held == kNoKey) held = atomicCompSwap(sKeys[slot], kNoKey, extent.key);
        if (held == kNoKey || held == extent.key) {
            note(slot, extent);
            return;
        }
    }
    atomicOr(sIsFull, 1u);
}

/// The group's result in the slot.
Extent getListed(uint slot) {
    Extent extent = kNoExtent;
    extent.key = sKeys[slot];
    extent.isOfUse = true;
    extent.depths = vec2(uintBitsToFloat(sNearest[slot]), uintBitsToFloat(sFarthest[slot]));
    extent.bins = uvec2(sBins[0][slot], sBins[1][slot]);
    extent.low = ivec2(sLowX[slot], sLowY[slot]);
    extent.high = ivec2(sHighX[slot], sHighY[slot]);
    return extent;
}

/// \param perAlong LayerMotion::parallaxes
void addBin(uvec2 surface, float perAlong, bool perspective, inout Extent extent) {
    if (perAlong <= 0.0f || !extent.isOfUse) return;
    float along = alongOf(uintBitsToFloat(surface.x), perspective);
    uint bin = parallaxBin(perAlong * along);
    extent.bins[bin >> 5u] |= 1u << (bin & 31u);
}

/// Lists what covers samples of a pixel that its own surface does not.
void listOther(LayerMotion layer, ivec2 pixel, bool perspective) {
    uvec2 other = textureLod(uEdgeSurface, uvOfPixel(pixel), 0.0f).xy;
    Extent extent = beginExtent(layer, keyOfId(other.y));
    if (extent.deforms) return; // found by the pixels that are its own
    growExtent(other, pixel, extent);
    addBin(other, parallaxOf(layer, extent.key), perspective, extent);
    listExtent(extent);
}

/// Adds a pixel to the extent if it is of the same entity; lists the extent and begins another if it
/// is not.
/// \param perAlong LayerMotion::parallaxes of the extent's entity
void addPixel(
    LayerMotion layer, ivec2 pixel, bool perspective, inout Extent extent, inout float perAlong
) {
    uvec2 surface = textureLod(uSurface, uvOfPixel(pixel), 0.0f).xy;
    uint key = keyOf(surface);
    if (key != extent.key) {
        listExtent(extent);
        extent = beginExtent(layer, key);
        perAlong = parallaxOf(layer, key);
        if (extent.deforms) {
            // Deforming entities are listed part by part (resolved_parts.comp).
            extent.isOfUse = false;
            atomicOr(sDeforms, 1u);
        }
    }
    growExtent(surface, pixel, extent);
    addBin(surface, perAlong, perspective, extent);
    if (kHasEdges && otherSamplesOf(surface) != 0u) listOther(layer, pixel, perspective);
}

/// Where an entity of the tile is seen at the instants of a sample: those of all sets, which follow one
/// another. It is entered once for all of them, since that takes longest.
SeenBox findBox(LayerMotion layer, Extent extent, uint sample_, bool perspective) {
    SeenBox box = kNoBox;
    addSample(layer, extent, sample_, perspective, box);
    return box;
}

/// For the pass that finds the deforming parts in the tile.
void listDeforming() {
    uint index = atomicAdd(uDeforming.header.count, 1u);
    uDeforming.entries[index] = gl_WorkGroupID.x | gl_WorkGroupID.y << 16;
    atomicMax(uDeformingArguments.groupsX, min(index + 1u, kListRow));
    if (index % kListRow == 0u) atomicAdd(uDeformingArguments.groupsY, 1u);
}

void main() {
    const uint kThreads = kGroupSize * kThreadRows;
    uint thread = gl_LocalInvocationIndex;
    for (uint slot = thread; slot < kCandidatesPerTile; slot += kThreads) {
        sKeys[slot] = kNoKey;
        sNearest[slot] = 0xFFFFFFFFu;
        sFarthest[slot] = 0u;
        sBins[0][slot] = sBins[1][slot] = 0u;
        sLowX[slot] = sLowY[slot] = 0x7FFFFFFF;
        sHighX[slot] = sHighY[slot] = -0x7FFFFFFF;
    }
    if (thread == 0u) {
        sDeforms = 0u;
        sIsFull = 0u;
    }
    barrier();
    InstantMotionsRef motions = InstantMotionsRef(method.motions);
    LayerMotion layer = getLayer(motions, kLayer);
    uvec2 origin = gl_WorkGroupID.xy * kCandidateTilePx + gl_LocalInvocationID.xy;
    bool perspective = motions.value.isPerspective != 0u;
    Extent extent = kNoExtent;
    float perAlong = 0.0f;
    [[dont_unroll]] for (uint y = 0u; y < kCandidateTilePx; y += kThreadRows)
        [[dont_unroll]] for (uint x = 0u; x < kCandidateTilePx; x += kGroupSize) {
            uvec2 pixel = origin + uvec2(x, y);
            if (all(lessThan(pixel, params.sizePx)))
                addPixel(layer, ivec2(pixel), perspective, extent, perAlong);
        }
    listExtent(extent);
    barrier();
    if (sDeforms != 0u && thread == 0u) listDeforming();
    uint ownTile = gl_WorkGroupID.y * countTiles(params.sizePx).x + gl_WorkGroupID.x;
    if (sIsFull != 0u) {
        // Which of them are listed is chance: none counts.
        if (thread == 0u) noteUnlistedSource(ownTile, kLayer);
        return;
    }
    for (uint pair = thread; pair < kCandidatesPerTile * params.sampleCount; pair += kThreads) {
        uint slot = pair / params.sampleCount;
        if (sKeys[slot] == kNoKey) break;
        uint sample_ = pair - slot * params.sampleCount;
        Extent listed = getListed(slot);
        // Entities in the tile now must be candidates, even if they are there at no instant.
        if (kLayer == kRasterLayer && sample_ == 0u)
            enter(ownTile, listed.key, listed.depths, 0u, listed.bins);
        SeenBox box = findBox(layer, listed, sample_, perspective);
        if (box.parts != 0u) enterBox(listed.key, box, listed.bins);
    }
}
