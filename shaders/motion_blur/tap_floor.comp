// SPDX-License-Identifier: MIT
// What a gather cannot be faster than on a device: the fetches of reconstruct.comp at its places in
// its blocks, averaged. A benchmark's measure, no blur.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "motion_blur/motion_blur_shared.h"
#define SHUTTER_BLOCK_LIST_BINDING 4
#include "motion_blur/block_list.glsl"
#include "motion_blur/taps.glsl"

layout(local_size_x = kGroupSize, local_size_y = kGroupSize) in;
layout(push_constant, scalar) uniform Push { MotionBlurParams params; };
layout(binding = 0) uniform sampler2D uColor;
layout(binding = 1) uniform sampler2D uMotionDepth;
layout(binding = 2) uniform sampler2D uDominant;
layout(binding = 3, rgba16f) uniform writeonly image2D uMean;

void main() {
    ivec2 pixel;
    if (!findPixel(params.sizePx, pixel)) return;
    vec2 centre = vec2(pixel) + 0.5f;
    vec2 pixelsToUv = 1.0f / vec2(params.sizePx);
    vec2 tile = tileUv(centre, params.tileSizePx, params.tileCount);
    vec2 dominant = textureLod(uDominant, tile, 0.0f).xy;
    float offset = mix(0.5f, interleavedGradientNoise(floor(centre)), params.jitter);
    vec3 sum = vec3(0.0f);
    for (uint i = 0u; i < params.sampleCount; ++i) {
        float u = tapPosition(i, offset, params.sampleCount, params.rasterTime);
        vec2 at = (centre + dominant * u) * pixelsToUv;
        sum += textureLod(uColor, at, 0.0f).rgb + textureLod(uMotionDepth, at, 0.0f).xyz;
    }
    imageStore(uMean, pixel, vec4(storableColor(sum / float(params.sampleCount)), 1.0f));
}
