// SPDX-License-Identifier: MIT
// A finer image mixed with a coarser one, which is spread by a tent (Jimenez 2014). What is added was
// taken away: the picture keeps its light.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "bloom/bloom.glsl"
#include "bloom/bloom_shared.h"
#include "common/numeric.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(push_constant, scalar) uniform Push { BloomParams params; };
layout(binding = 0) uniform sampler2D uFine; // nearest
layout(binding = 1) uniform sampler2D uCoarse;
layout(binding = 2, rgba16f) uniform writeonly image2D uMixed;

/// Three by three, one texel of the coarse image apart. \param at in its texels
vec3 spreadCoarse(vec2 at) {
    vec3 sum = vec3(0.0f);
    for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x)
            sum += float((2 - abs(x)) * (2 - abs(y))) *
                   textureLod(uCoarse, (at + vec2(x, y)) / vec2(params.sourcePx), 0.0f).rgb;
    return sum / 16.0f;
}

void main() {
    uvec2 pixel = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(pixel, params.sizePx))) return;
    vec2 uv = (vec2(pixel) + 0.5f) / vec2(params.sizePx);
    vec4 fine = textureLod(uFine, uv, 0.0f);
    vec3 scattered = findHighlight(fine.rgb, params.threshold, params.knee);
    vec3 spread = spreadCoarse(0.5f * (vec2(pixel) + 0.5f));
    vec3 mixed = fine.rgb + params.share * (spread - scattered);
    imageStore(uMixed, ivec2(pixel), vec4(storableColor(mixed), fine.a));
}
