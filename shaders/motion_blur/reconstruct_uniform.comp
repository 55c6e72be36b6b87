// SPDX-License-Identifier: MIT
// Gather where all that taps meet moves by the dominant motion: they read no motion and no depth,
// and weigh as two that move alike at one depth. What lies in front of what makes no difference then:
// everything in reach passes the pixel at the same speed.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "motion_blur/motion_blur_shared.h"
#define SHUTTER_BLOCK_LIST_BINDING 3
#include "motion_blur/block_list.glsl"
#include "motion_blur/taps.glsl"

layout(local_size_x = kGroupSize, local_size_y = kGroupSize) in;
layout(push_constant, scalar) uniform Push { MotionBlurParams params; };
layout(binding = 0) uniform sampler2D uColor;
layout(binding = 1) uniform sampler2D uDominant;
layout(binding = 2, rgba16f) uniform writeonly image2D uBlurred;

void main() {
    ivec2 pixel;
    if (!findPixel(params.sizePx, pixel)) return;
    vec2 centre = vec2(pixel) + 0.5f;
    vec2 pixelsToUv = 1.0f / vec2(params.sizePx);
    vec2 tile = tileUv(centre, params.tileSizePx, params.tileCount);
    vec2 dominant = textureLod(uDominant, tile, 0.0f).xy; // never still: the block is uniform
    float range = length(dominant);
    float weight = centreWeight(range);
    vec3 sum = textureLod(uColor, centre * pixelsToUv, 0.0f).rgb * weight;
    float offset = mix(0.5f, interleavedGradientNoise(floor(centre)), params.jitter);
    float first = tapPosition(0u, offset, params.sampleCount, params.rasterShare);
    float perTap = 1.0f / float(params.sampleCount);
    // Of the smear's length to the side of u >= 0, and to the other, one u.
    vec2 perReach = vec2(
        smearRatio(range, range * params.rasterShare),
        smearRatio(range, range * (1.0f - params.rasterShare))
    );
    for (uint i = 0u; i < params.sampleCount; ++i) {
        float u = warpTapAt(params.response, first + float(i) * perTap, params.rasterShare);
        float tapWeight = uniformWeight(abs(u) * (u >= 0.0f ? perReach.x : perReach.y));
        sum += textureLod(uColor, (centre + dominant * u) * pixelsToUv, 0.0f).rgb * tapWeight;
        weight += tapWeight;
    }
    imageStore(uBlurred, pixel, vec4(sum / weight, 1.0f));
}
