// SPDX-License-Identifier: MIT
// Longest motion of the revealed layer in each tile with masked pixels; elsewhere it is the raster's.
// A group per listed tile.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "motion_blur/motion_blur_shared.h"
#include "motion_blur/weights.glsl"
#define SHUTTER_TILE_LIST_BINDING 4
#include "motion_blur/tile_list.glsl"

layout(local_size_x = kGroupSize, local_size_y_id = 0) in;
layout(constant_id = 1) const uint kRows = kGroupSize; // of a group
layout(push_constant, scalar) uniform Push { MotionBlurParams params; };
layout(binding = 0) uniform sampler2D uMotionDepth;
layout(binding = 1) uniform sampler2D uRevealMotionDepth;
layout(binding = 2) uniform sampler2D uMask;
layout(binding = 3, rg32f) uniform writeonly image2D uRevealTiles;

const uint kThreads = kGroupSize * kRows;
shared vec2 sLongest[kThreads];

void main() {
    uint index = gl_WorkGroupID.y * kListRow + gl_WorkGroupID.x;
    bool listed = index < uTileList.header.count;
    uint word = listed ? uTileList.words[index] : 0u;
    uvec2 tile = uvec2(word & 0xFFFFu, word >> 16);
    uvec2 first = tile * params.tileSizePx;
    uvec2 end = listed ? min(first + params.tileSizePx, params.sizePx) : first;
    vec2 pixelsToUv = 1.0f / vec2(params.sizePx);
    vec2 longest = vec2(0.0f);
    for (uint y = first.y + gl_LocalInvocationID.y; y < end.y; y += kRows)
        for (uint x = first.x + gl_LocalInvocationID.x; x < end.x; x += kGroupSize) {
            vec2 uv = (vec2(x, y) + 0.5f) * pixelsToUv;
            vec3 texel;
            if (textureLod(uMask, uv, 0.0f).x > 0.5f)
                texel = textureLod(uRevealMotionDepth, uv, 0.0f).xyz;
            else
                texel = textureLod(uMotionDepth, uv, 0.0f).xyz;
            longest = longerMotion(
                longest, shownMotion(texel.xy, texel.z, params.maxMotionDepth)
            );
        }
    uint thread = gl_LocalInvocationIndex;
    sLongest[thread] = longest;
    barrier();
    // First down each column, then across: no thread has to take over all.
    if (thread < kGroupSize) {
        for (uint i = thread + kGroupSize; i < kThreads; i += kGroupSize)
            longest = longerMotion(longest, sLongest[i]);
        sLongest[thread] = longest;
    }
    barrier();
    if (!listed || thread != 0u) return;
    for (uint i = 1u; i < kGroupSize; ++i) longest = longerMotion(longest, sLongest[i]);
    longest = clampMotion(longest, float(params.tileSizePx));
    imageStore(uRevealTiles, ivec2(tile), vec4(longest, 0.0f, 0.0f));
}
