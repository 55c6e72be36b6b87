// SPDX-License-Identifier: MIT
// Dominant motion: the longest of a tile's n x n neighbourhood; and the tile's class.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "motion_blur/block_class.glsl"
#include "motion_blur/weights.glsl"

layout(local_size_x = kGroupSize, local_size_y = kGroupSize) in;
layout(push_constant, scalar) uniform Push { MotionBlurParams params; };
layout(binding = 0) uniform sampler2D uTiles;
layout(binding = 1) uniform sampler2D uRanges;
layout(binding = 2, rg32f) uniform writeonly image2D uDominant;
layout(binding = 3, r32f) uniform writeonly image2D uTileClass;

vec2 uvOf(ivec2 tile) { return (vec2(tile) + 0.5f) / vec2(params.tileCount); }

/// Tests the tiles that taps reach: no tap is farther away than a tile's size, regardless of the
/// size of the neighbourhood for the dominant motion.
float classify(ivec2 tile, vec2 dominant) {
    float deviation = 0.0f;
    vec2 depth = vec2(3.0e38f, -3.0e38f);
    ivec2 first = max(tile - 1, ivec2(0));
    ivec2 last = min(tile + 1, ivec2(params.tileCount) - 1);
    for (int y = first.y; y <= last.y; ++y)
        for (int x = first.x; x <= last.x; ++x) {
            vec2 uv = uvOf(ivec2(x, y));
            vec3 ranges = textureLod(uRanges, uv, 0.0f).xyz;
            vec2 longest = textureLod(uTiles, uv, 0.0f).xy;
            deviation = max(deviation, length(longest - dominant) + ranges.x);
            depth = vec2(min(depth.x, ranges.y), max(depth.y, ranges.z));
        }
    return classifyTile(
        length(dominant), deviation, depth.y - depth.x, params.uniformMotionPx,
        softExtent(depth.x, params.softDepthExtent, params.softDepthShare)
    );
}

void main() {
    ivec2 tile = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(uvec2(tile), params.tileCount))) return;
    vec2 longest = vec2(0.0f);
    ivec2 first = max(tile - params.neighbourRadius, ivec2(0));
    ivec2 last = min(tile + params.neighbourRadius, ivec2(params.tileCount) - 1);
    for (int y = first.y; y <= last.y; ++y)
        for (int x = first.x; x <= last.x; ++x)
            longest = longerMotion(longest, textureLod(uTiles, uvOf(ivec2(x, y)), 0.0f).xy);
    imageStore(uDominant, tile, vec4(longest, 0.0f, 0.0f));
    imageStore(uTileClass, tile, vec4(classify(tile, longest)));
}
