// SPDX-License-Identifier: MIT
// Longest motion in each tile, clamped to the tile's size. One group a tile, one barrier.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "motion_blur/motion_blur_shared.h"
#include "motion_blur/weights.glsl"

layout(local_size_x = kGroupSize, local_size_y = kGroupSize) in;
layout(push_constant, scalar) uniform Push { MotionBlurParams params; };
layout(binding = 0) uniform sampler2D uMotionDepth;
layout(binding = 1, rg32f) uniform writeonly image2D uTiles;

const uint kTileThreads = kGroupSize * kGroupSize;
shared vec2 sLongest[kTileThreads];

void main() {
    uvec2 tile = gl_WorkGroupID.xy;
    uvec2 first = tile * params.tileSizePx;
    uvec2 end = min(first + params.tileSizePx, params.sizePx); // the last tile may be partial
    vec2 pixelsToUv = 1.0f / vec2(params.sizePx);
    vec2 longest = vec2(0.0f);
    // Threads walk the tile as an 8 x 8 block: no division by the tile's width.
    for (uint y = first.y + gl_LocalInvocationID.y; y < end.y; y += kGroupSize)
        for (uint x = first.x + gl_LocalInvocationID.x; x < end.x; x += kGroupSize) {
            vec2 uv = (vec2(x, y) + 0.5f) * pixelsToUv;
            longest = longerMotion(longest, textureLod(uMotionDepth, uv, 0.0f).xy);
        }
    sLongest[gl_LocalInvocationIndex] = longest;
    barrier();
    if (gl_LocalInvocationIndex != 0u) return;
    for (uint i = 1u; i < kTileThreads; ++i) longest = longerMotion(longest, sLongest[i]);
    longest = clampMotion(longest, float(params.tileSizePx));
    imageStore(uTiles, ivec2(tile), vec4(longest, 0.0f, 0.0f));
}
