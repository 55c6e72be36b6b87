// SPDX-License-Identifier: MIT
// Which entities of a layer each tile of the picture may see during the exposure, and between which
// depths. A group takes a tile of the layer: it lists the entities in it with their extents, then
// finds for each and each instant where that box is seen, and enters it in the lists of the tiles
// there.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "motion_blur/resolved.glsl"
#include "motion_blur/resolved_parts_shared.h"

layout(constant_id = 0) const uint kLayer = kRasterLayer;

// Each thread takes several of the tile's pixels: on software devices a thread that waits at a barrier
// is expensive.
layout(local_size_x = kGroupSize, local_size_y_id = 1) in;
layout(constant_id = 2) const uint kThreadRows = kGroupSize; // of a group
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

#include "motion_blur/resolved_enter.glsl"

// What the group found in its tile.
shared uint sKeys[kCandidatesPerTile];
shared uint sNearest[kCandidatesPerTile];
shared uint sFarthest[kCandidatesPerTile];
shared int sLowX[kCandidatesPerTile];
shared int sLowY[kCandidatesPerTile];
shared int sHighX[kCandidatesPerTile];
shared int sHighY[kCandidatesPerTile];
shared bool sDeforms; // something in it does

/// Beyond the box: half a pixel to its border, one for what is interpolated, and some for rounding.
const float kMarginPx = 2.0f;

/// Pixels of one entity.
struct Extent {
    uint key;     // kNoKey: none
    bool isOfUse; // it moves, and it is known how
    vec2 depths;
    ivec2 low;
    ivec2 high;
};

const Extent kNoExtent =
    Extent(kNoKey, false, vec2(3.0e38f, 0.0f), ivec2(0x7FFFFFFF), ivec2(-0x7FFFFFFF));

void note(uint slot, Extent extent) {
    atomicMin(sNearest[slot], floatBitsToUint(extent.depths.x));
    atomicMax(sFarthest[slot], floatBitsToUint(extent.depths.y));
    atomicMin(sLowX[slot], extent.low.x);
    atomicMin(sLowY[slot], extent.low.y);
    atomicMax(sHighX[slot], extent.high.x);
    atomicMax(sHighY[slot], extent.high.y);
}

void listExtent(Extent extent) {
    if (!extent.isOfUse) return;
    for (uint slot = 0u; slot < kCandidatesPerTile; ++slot) {
        uint held = sKeys[slot];
        if (held == kNoKey) held = atomicCompSwap(sKeys[slot], kNoKey, extent.key);
        if (held == kNoKey || held == extent.key) {
            note(slot, extent);
            return;
        }
    }
    atomicAdd(uCounters.overflown, 1u);
}

/// Adds a pixel to the extent if it is of the same entity; lists the extent and begins another if it
/// is not.
void addPixel(LayerMotion layer, ivec2 pixel, inout Extent extent) {
    vec2 uv = (vec2(pixel) + 0.5f) / vec2(params.sizePx); // texelFetch is slow on software devices
    uvec2 surface = textureLod(uSurface, uv, 0.0f).xy;
    uint key = keyOf(surface);
    if (key != extent.key) {
        listExtent(extent);
        uint mover = findMover(layer, key);
        extent = kNoExtent;
        extent.key = key;
        // What deforms is listed part by part (resolved_parts.comp).
        extent.isOfUse = mover != kNoMover && mover != kDeformedMover && !isStillMover(layer, mover);
        if (mover == kDeformedMover) sDeforms = true;
    }
    if (!extent.isOfUse) return;
    float depth = depthOfKey(key, uintBitsToFloat(surface.x));
    extent.depths = vec2(min(extent.depths.x, depth), max(extent.depths.y, depth));
    extent.low = min(extent.low, pixel);
    extent.high = max(extent.high, pixel);
}

void addRigid(
    LayerMotion layer, uint slot, uint mover, uint instant, bool perspective, inout SeenBox box
) {
    InstantMotion motion =
        InstantMotionTable(layer.motions).motions[mover * method.instantCount + instant];
    if (motion.instantFromRaster[2] == vec4(0.0f)) return;
    vec2 low = vec2(1.0e9f);
    vec2 high = vec2(-1.0e9f);
    vec2 depths = vec2(3.0e38f, 0.0f);
    bool isInFront = false;
    for (uint corner = 0u; corner < 8u; ++corner) {
        vec2 at = vec2(
            (corner & 1u) != 0u ? float(sHighX[slot] + 1) : float(sLowX[slot]),
            (corner & 2u) != 0u ? float(sHighY[slot] + 1) : float(sLowY[slot])
        );
        float depth = uintBitsToFloat((corner & 4u) != 0u ? sFarthest[slot] : sNearest[slot]);
        vec3 seen = transformRows(motion.instantFromRaster, pictureSpace(at, depth, perspective));
        vec2 place = clamp(projectPicture(seen, perspective), -1.0e8f, 1.0e8f);
        low = min(low, place);
        high = max(high, place);
        depths = vec2(min(depths.x, seen.z), max(depths.y, seen.z));
        isInFront = isInFront || seen.z > 0.0f || !perspective;
    }
    if (isInFront) addBox(instant, low - kMarginPx, high + kMarginPx, depths, box);
}

/// Where an entity of the tile is seen at the instants of a sample: those of all sets, which follow one
/// another. It is entered once for all of them, since that takes longest.
SeenBox findBox(LayerMotion layer, uint slot, uint sample_, bool perspective) {
    SeenBox box = kNoBox;
    uint mover = findMover(layer, sKeys[slot]);
    for (uint set = 0u; set < method.setCount; ++set) {
        uint instant = sample_ * method.setCount + set;
        addRigid(layer, slot, mover, instant, perspective, box);
    }
    return box;
}

/// For the pass that finds the parts of what deforms in the tile.
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
        sLowX[slot] = sLowY[slot] = 0x7FFFFFFF;
        sHighX[slot] = sHighY[slot] = -0x7FFFFFFF;
    }
    if (thread == 0u) sDeforms = false;
    barrier();
    InstantMotionsRef motions = InstantMotionsRef(method.motions);
    LayerMotion layer = getLayer(motions, kLayer);
    uvec2 origin = gl_WorkGroupID.xy * kCandidateTilePx + gl_LocalInvocationID.xy;
    Extent extent = kNoExtent;
    for (uint y = 0u; y < kCandidateTilePx; y += kThreadRows)
        for (uint x = 0u; x < kCandidateTilePx; x += kGroupSize) {
            uvec2 pixel = origin + uvec2(x, y);
            if (all(lessThan(pixel, params.sizePx))) addPixel(layer, ivec2(pixel), extent);
        }
    listExtent(extent);
    barrier();
    if (sDeforms && thread == 0u) listDeforming();
    bool perspective = motions.value.isPerspective != 0u;
    for (uint pair = thread; pair < kCandidatesPerTile * params.sampleCount; pair += kThreads) {
        uint slot = pair / params.sampleCount;
        if (sKeys[slot] == kNoKey) break;
        uint sample_ = pair - slot * params.sampleCount;
        // What is in the tile now must be looked at, even if at no instant it is.
        if (kLayer == kRasterLayer && sample_ == 0u)
            enter(
                gl_WorkGroupID.y * countTiles().x + gl_WorkGroupID.x, sKeys[slot],
                vec2(uintBitsToFloat(sNearest[slot]), uintBitsToFloat(sFarthest[slot])), 0u
            );
        SeenBox box = findBox(layer, slot, sample_, perspective);
        if (box.parts != 0u) enterBox(sKeys[slot], box);
    }
}
