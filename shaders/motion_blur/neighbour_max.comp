// SPDX-License-Identifier: MIT
// Dominant motion: the longest of a tile's n x n neighbourhood.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "motion_blur/motion_blur_shared.h"
#include "motion_blur/weights.glsl"

layout(local_size_x = kGroupSize, local_size_y = kGroupSize) in;
layout(push_constant, scalar) uniform Push { MotionBlurParams params; };
layout(binding = 0) uniform sampler2D uTiles;
layout(binding = 1, rg32f) uniform writeonly image2D uDominant;

void main() {
    ivec2 tile = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(uvec2(tile), params.tileCount))) return;
    vec2 longest = vec2(0.0f);
    ivec2 last = ivec2(params.tileCount) - 1;
    for (int y = -params.neighbourRadius; y <= params.neighbourRadius; ++y)
        for (int x = -params.neighbourRadius; x <= params.neighbourRadius; ++x) {
            ivec2 at = tile + ivec2(x, y);
            if (any(lessThan(at, ivec2(0))) || any(greaterThan(at, last))) continue;
            longest = longerMotion(longest, texelFetch(uTiles, at, 0).xy);
        }
    imageStore(uDominant, tile, vec4(longest, 0.0f, 0.0f));
}
