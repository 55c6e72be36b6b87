// SPDX-License-Identifier: MIT
// NeighborMax and TileVariance of Guertin et al. 2014: the longest motion among the neighbours whose
// smear can come over this tile, and how much the directions around it differ.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "motion_blur/motion_blur_shared.h"
#include "motion_blur/guertin2014.glsl"

layout(local_size_x = kGroupSize, local_size_y = kGroupSize) in;
layout(push_constant, scalar) uniform Push { MotionBlurParams params; };
layout(binding = 0) uniform sampler2D uTiles;
layout(binding = 1, rg32f) uniform writeonly image2D uDominant;
layout(binding = 2, r32f) uniform writeonly image2D uVariance;

vec2 tileMotion(ivec2 tile) {
    return textureLod(uTiles, (vec2(tile) + 0.5f) / vec2(params.tileCount), 0.0f).xy;
}

/// 1 - mean |cos| between a tile's motion and its moving neighbours' (itself included). A still tile
/// has no direction: it is not a neighbour, and its own is the dominant one, which is never still.
float measureVariance(ivec2 tile, ivec2 first, ivec2 end, vec2 dominant) {
    vec2 own = tileMotion(tile);
    vec2 reference = length(own) < kStillPx ? dominant : own;
    float sum = 0.0f;
    float count = 0.0f;
    for (int y = first.y; y < end.y; ++y)
        for (int x = first.x; x < end.x; ++x) {
            vec2 motion = tileMotion(ivec2(x, y));
            if (length(motion) < kStillPx) continue;
            sum += alignment(reference, motion);
            count += 1.0f;
        }
    return saturate(1.0f - sum / count);
}

void main() {
    ivec2 tile = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(uvec2(tile), params.tileCount))) return;
    ivec2 first = max(tile - params.neighbourRadius, ivec2(0));
    ivec2 end = min(tile + params.neighbourRadius + 1, ivec2(params.tileCount));
    vec2 dominant = vec2(0.0f);
    for (int y = first.y; y < end.y; ++y)
        for (int x = first.x; x < end.x; ++x) {
            vec2 motion = tileMotion(ivec2(x, y));
            if (reachesTile(ivec2(x, y) - tile, motion)) dominant = longerMotion(dominant, motion);
        }
    float variance = 0.0f;
    if (length(dominant) >= kStillPx) variance = measureVariance(tile, first, end, dominant);
    imageStore(uDominant, tile, vec4(dominant, 0.0f, 0.0f));
    imageStore(uVariance, tile, vec4(variance));
}
