// SPDX-License-Identifier: MIT
// Third test of the ray mask, the range check: a moving pixel is masked when any sample along its
// motion is an edge; with kFlagRelativeMask an edge in front of it does not count, since what hides
// there is the pixel itself. Lists masked pixels for the reveal, and blocks and tiles that have some for the
// gather of the revealed layer.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "motion_blur/hybrid_shared.h"
#include "motion_blur/motion_blur_shared.h"
#include "motion_blur/weights.glsl"
#define SHUTTER_BLOCK_LIST_BINDING 4
#define SHUTTER_BLOCK_LIST_ACCESS // the flags are written
#include "motion_blur/block_list.glsl"

layout(local_size_x = kGroupSize, local_size_y = kGroupSize) in;
layout(push_constant, scalar) uniform Push {
    MotionBlurParams params;
    HybridParams method;
};
layout(binding = 0) uniform sampler2D uMotionDepth;
layout(binding = 1) uniform sampler2D uEdge;
layout(binding = 2) uniform sampler2D uEdgeBlocks;
layout(binding = 3, r8) uniform writeonly image2D uMask;
layout(binding = 5, scalar) buffer MaskList {
    MaskHeader header;
    uint pixels[];
} uMasked;
layout(binding = 6, scalar) buffer Arguments { DispatchArguments uReveal; };
layout(binding = 7, scalar) buffer SortedBlocks {
    BlockHeader header;
    uint entries[];
} uSorted;
layout(binding = 8, scalar) buffer SortedArguments { DispatchArguments uLists[kListCount]; };
layout(binding = 9, scalar) buffer Tiles {
    TileHeader header;
    uint words[]; // listed tiles, then a flag for each tile of the picture
} uTiles;
layout(binding = 10, scalar) buffer TileArguments { DispatchArguments uTileArguments[2]; };
layout(binding = 11) uniform usampler2D uEntityId;

/// Edges of a silhouette are two pixels wide (half the Sobel window): steps of at most one and a
/// half cannot jump over one.
const float kStepPx = 1.5f;
const uint kTilesPerGroup = 64u; // of reveal_neighbour_max.comp

bool meetsEdgeBlock(vec2 centre, vec2 offset, float range) {
    // A place's block knows of every edge within a block's length of it, twice of what steps of one
    // leave between them.
    float steps = max(ceil(range / float(kGroupSize)), 1.0f);
    vec2 blockUv = 1.0f / (ceil(vec2(params.sizePx) / float(kGroupSize)) * float(kGroupSize));
    vec2 last = vec2(params.sizePx) - 0.5f;
    for (float i = 0.0f; i <= steps; i += 1.0f) {
        vec2 at = clamp(centre + offset * (i / steps), vec2(0.5f), last);
        if (textureLod(uEdgeBlocks, at * blockUv, 0.0f).x > 0.5f) return true;
    }
    return false;
}

/// Whether the edge belongs to the pixel's surface or is no nearer.
bool mayReveal(vec2 edgeUv, vec2 centreUv, float depth) {
    if (textureLod(uEntityId, edgeUv, 0.0f).x == textureLod(uEntityId, centreUv, 0.0f).x)
        return true;
    float soft = softExtent(depth, params.softDepthExtent, params.softDepthShare);
    return textureLod(uMotionDepth, edgeUv, 0.0f).z > depth - soft;
}

bool meetsEdge(vec2 centre, vec2 offset, float depth) {
    float range = length(offset);
    if (!meetsEdgeBlock(centre, offset, range)) return false;
    bool isRelative = (method.flags & kFlagRelativeMask) != 0u;
    uint steps = uint(ceil(range / kStepPx));
    for (uint i = 0u; i <= steps; ++i) {
        vec2 uv = (centre + offset * (float(i) / float(max(steps, 1u)))) / vec2(params.sizePx);
        if (textureLod(uEdge, uv, 0.0f).x > 0.5f &&
            (!isRelative || mayReveal(uv, centre / vec2(params.sizePx), depth)))
            return true;
    }
    return false;
}

bool isMasked(ivec2 pixel) {
    vec2 centre = vec2(pixel) + 0.5f;
    vec3 target = textureLod(uMotionDepth, centre / vec2(params.sizePx), 0.0f).xyz;
    vec2 motion = limitMotion(target, float(params.tileSizePx), params.maxMotionDepth);
    if (length(motion) < kStillPx) return false;
    // A side that is not exposed holds only the pixel itself, which the other side has tested.
    if (params.rasterTime > 0.0f && meetsEdge(centre, motion * params.rasterTime, target.z))
        return true;
    return params.rasterTime < 1.0f &&
           meetsEdge(centre, motion * (params.rasterTime - 1.0f), target.z);
}

#include "motion_blur/masked_blocks.glsl"

void listTile(uvec2 tile) {
    uint tiles = params.tileCount.x * params.tileCount.y;
    if (atomicExchange(uTiles.words[tiles + tile.y * params.tileCount.x + tile.x], 1u) != 0u) return;
    uint index = atomicAdd(uTiles.header.count, 1u);
    uTiles.words[index] = tile.x | tile.y << 16;
    if (index < kListRow) atomicMax(uTileArguments[0].groupsX, index + 1u);
    if (index % kListRow == 0u) atomicAdd(uTileArguments[0].groupsY, 1u);
    // And a thread a tile, in the same rows.
    uint group = index / kTilesPerGroup;
    if (group < kListRow) atomicMax(uTileArguments[1].groupsX, group + 1u);
    if (index % (kTilesPerGroup * kListRow) == 0u) atomicAdd(uTileArguments[1].groupsY, 1u);
}

/// Lists the block and every tile that it lies in: one without masked pixels is worked out like the
/// others and comes out as the raster's.
void markBlock(uvec2 block) {
    if (!listBlock(block)) return;
    vec2 first = vec2(block * kGroupSize) + 0.5f;
    vec2 last = min(first + float(kGroupSize - 1u), vec2(params.sizePx) - 0.5f);
    uvec2 firstTile = uvec2(floor(first / float(params.tileSizePx)));
    uvec2 lastTile = uvec2(floor(last / float(params.tileSizePx)));
    for (uint y = firstTile.y; y <= lastTile.y; ++y)
        for (uint x = firstTile.x; x <= lastTile.x; ++x) listTile(uvec2(x, y));
}

#include "motion_blur/mask_list.glsl"

void main() {
    ivec2 pixel;
    bool isInside = findPixel(params.sizePx, pixel);
    if (kListTogether == 0u && !isInside) return;
    listMasked(pixel, isInside, method.rayShare);
}
