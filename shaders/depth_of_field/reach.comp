// SPDX-License-Identifier: MIT
// Largest circle of confusion that may reach a tile, and nearest depth of the tiles that do.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "depth_of_field/confusion.glsl"

layout(local_size_x = kLensGroup, local_size_y = kLensGroup) in;
layout(push_constant, scalar) uniform Push { LensFilterParams params; };
layout(binding = 0) uniform sampler2D uTiles;
layout(binding = 1, rg32f) uniform writeonly image2D uReach;

void main() {
    ivec2 tile = ivec2(gl_GlobalInvocationID.xy);
    ivec2 count = ivec2(params.tileCount);
    if (any(greaterThanEqual(tile, count))) return;
    vec2 reach = texelFetch(uTiles, tile, 0).xy;
    for (int y = max(tile.y - kReachTiles, 0); y <= min(tile.y + kReachTiles, count.y - 1); ++y)
        for (int x = max(tile.x - kReachTiles, 0); x <= min(tile.x + kReachTiles, count.x - 1); ++x) {
            vec2 other = texelFetch(uTiles, ivec2(x, y), 0).xy;
            ivec2 between = max(abs(ivec2(x, y) - tile) - 1, ivec2(0));
            if (other.x < length(vec2(between)) * float(params.tilePx)) continue;
            reach = vec2(max(reach.x, other.x), min(reach.y, other.y));
        }
    imageStore(uReach, tile, vec4(reach, 0.0f, 0.0f));
}
