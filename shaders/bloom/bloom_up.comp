// SPDX-License-Identifier: MIT
// A finer image mixed with a coarser one, which is spread by a tent (Jimenez 2014). The added light
// was subtracted before: the total light is preserved.
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

/// Three by three, one texel of the coarse image apart, each between its texels: four by four texels
/// whose weights are products. Two of a row are one linear tap where they meet. \param at in its texels
vec3 spreadCoarse(vec2 at) {
    vec2 middle = floor(at - 0.5f) + 0.5f;
    vec2 f = at - middle;
    // Weights of the four: 1 - f, 2 - f, 1 + f, f.
    vec2 first = 3.0f - 2.0f * f;
    vec2 second = 1.0f + 2.0f * f;
    vec2 a = (middle - 1.0f + (2.0f - f) / first) / vec2(params.sourcePx);
    vec2 b = (middle + 1.0f + f / second) / vec2(params.sourcePx);
    vec3 upper = first.x * textureLod(uCoarse, a, 0.0f).rgb +
                 second.x * textureLod(uCoarse, vec2(b.x, a.y), 0.0f).rgb;
    vec3 lower = first.x * textureLod(uCoarse, vec2(a.x, b.y), 0.0f).rgb +
                 second.x * textureLod(uCoarse, b, 0.0f).rgb;
    return (first.y * upper + second.y * lower) / 16.0f;
}

void main() {
    uvec2 pixel = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(pixel, params.sizePx))) return;
    vec4 fine = texelFetch(uFine, ivec2(pixel), 0);
    vec3 scattered = findHighlight(fine.rgb, params.threshold, params.knee);
    vec3 spread = spreadCoarse(0.5f * (vec2(pixel) + 0.5f));
    vec3 mixed = fine.rgb + params.share * (spread - scattered);
    imageStore(uMixed, ivec2(pixel), vec4(storableColor(mixed), fine.a));
}
