// SPDX-License-Identifier: MIT
// Dominant motion of the revealed layer in each tile with masked pixels. A thread a listed tile.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "motion_blur/motion_blur_shared.h"
#include "motion_blur/weights.glsl"
#define SHUTTER_TILE_LIST_BINDING 3
#include "motion_blur/tile_list.glsl"

const uint kThreads = kGroupSize * kGroupSize;

layout(local_size_x = kThreads) in;
layout(push_constant, scalar) uniform Push { MotionBlurParams params; };
layout(binding = 0) uniform sampler2D uTiles;
layout(binding = 1) uniform sampler2D uRevealTiles;
layout(binding = 2, rg32f) uniform writeonly image2D uRevealDominant;

vec2 longestIn(ivec2 tile) {
    vec2 uv = (vec2(tile) + 0.5f) / vec2(params.tileCount);
    uint tiles = params.tileCount.x * params.tileCount.y;
    uint flag = uTileList.words[tiles + uint(tile.y) * params.tileCount.x + uint(tile.x)];
    if (flag != 0u) return textureLod(uRevealTiles, uv, 0.0f).xy;
    return textureLod(uTiles, uv, 0.0f).xy;
}

void main() {
    uint index = (gl_WorkGroupID.y * kListRow + gl_WorkGroupID.x) * kThreads +
                 gl_LocalInvocationIndex;
    if (index >= uTileList.header.count) return;
    uint word = uTileList.words[index];
    ivec2 tile = ivec2(word & 0xFFFFu, word >> 16);
    ivec2 first = max(tile - params.neighbourRadius, ivec2(0));
    ivec2 last = min(tile + params.neighbourRadius, ivec2(params.tileCount) - 1);
    vec2 longest = vec2(0.0f);
    for (int y = first.y; y <= last.y; ++y)
        for (int x = first.x; x <= last.x; ++x)
            longest = longerMotion(longest, longestIn(ivec2(x, y)));
    imageStore(uRevealDominant, tile, vec4(longest, 0.0f, 0.0f));
}
