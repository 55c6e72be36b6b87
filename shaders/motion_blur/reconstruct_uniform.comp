// SPDX-License-Identifier: MIT
// Gather for neighbourhoods that move uniformly by the dominant motion: taps read no motion and no
// depth, and have the weight of equal motion and depth. Depth order is irrelevant: everything in
// reach passes the pixel at the same speed.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "motion_blur/gather_shared.h"
#include "motion_blur/motion_blur_shared.h"
#define SHUTTER_BLOCK_LIST_BINDING 3
#include "motion_blur/block_list.glsl"

layout(local_size_x = kGroupSize, local_size_y = kGroupSize) in;
layout(push_constant, scalar) uniform Push {
    MotionBlurParams params;
    GatherParams method;
};
layout(binding = 0) uniform sampler2D uColor;
layout(binding = 1) uniform sampler2D uDominant;
layout(binding = 2, rgba16f) uniform writeonly image2D uBlurred;

#include "motion_blur/gather_taps.glsl"

vec2 dominantAt(vec2 centre) {
    vec2 tile = tileUv(centre, params.tileSizePx, params.tileCount);
    return textureLod(uDominant, tile, 0.0f).xy; // never still: the block is uniform
}

vec4 gatherUniform(vec2 at, vec2 dominant) {
    vec2 pixelsToUv = 1.0f / vec2(params.sizePx);
    float range = length(dominant);
    float weight = centreWeight(range);
    vec3 sum = textureLod(uColor, at * pixelsToUv, 0.0f).rgb * weight;
    float offset = mix(0.5f, interleavedGradientNoise(floor(at)), params.jitter);
    float first = tapPosition(0u, offset, countTaps(), params.rasterTime);
    float perTap = 1.0f / float(countTaps());
    // One unit of u as a share of the smear's length: where u >= 0, and on the other side.
    vec2 perReach = vec2(
        smearRatio(range, range * params.rasterTime),
        smearRatio(range, range * (1.0f - params.rasterTime))
    );
    for (uint i = 0u; i < countTaps(); ++i) {
        float u = respondToTap(first + float(i) * perTap);
        float tapWeight = uniformWeight(abs(u) * (u >= 0.0f ? perReach.x : perReach.y));
        sum += textureLod(uColor, (at + dominant * u) * pixelsToUv, 0.0f).rgb * tapWeight;
        weight += tapWeight;
    }
    return vec4(sum / weight, 1.0f);
}

bool isInside(ivec2 pixel) { return all(lessThan(uvec2(pixel), params.sizePx)); }

/// Along a long smear neighbours differ by little: two pixels share the result of the first. Half
/// of the group's threads do the work, the others exit together.
void gatherHalf(uvec2 block, bool alongX) {
    uint i = gl_LocalInvocationIndex;
    if (i >= kGroupSize * kGroupSize / 2u) return;
    ivec2 stride = alongX ? ivec2(1, 0) : ivec2(0, 1);
    uint perRow = alongX ? kGroupSize / 2u : kGroupSize;
    ivec2 pixel = ivec2(block * kGroupSize) + ivec2(i % perRow, i / perRow) * (ivec2(1) + stride);
    if (!isInside(pixel)) return;
    vec2 centre = vec2(pixel) + 0.5f;
    vec4 color = gatherUniform(centre, dominantAt(centre));
    imageStore(uBlurred, pixel, color);
    if (isInside(pixel + stride)) imageStore(uBlurred, pixel + stride, color);
}

void main() {
    uvec2 block;
    if (!findBlock(params.sizePx, block)) return;
    vec2 motion = dominantAt(vec2(block * kGroupSize) + 0.5f);
    vec2 along = abs(motion);
    // Detail across the smear is preserved: pairs are adjacent along the smear, or there are none.
    bool straight = min(along.x, along.y) <= 0.25f * max(along.x, along.y);
    if (straight && length(motion) >= method.halfResolutionPx) {
        gatherHalf(block, along.x >= along.y);
        return;
    }
    ivec2 pixel = ivec2(block * kGroupSize + gl_LocalInvocationID.xy);
    if (!isInside(pixel)) return;
    vec2 centre = vec2(pixel) + 0.5f;
    imageStore(uBlurred, pixel, gatherUniform(centre, dominantAt(centre)));
}
