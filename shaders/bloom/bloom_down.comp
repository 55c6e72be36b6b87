// SPDX-License-Identifier: MIT
// Half of the resolution, by the 13 taps of Jimenez 2014 ("Next Generation Post Processing in Call of
// Duty: Advanced Warfare"), which leave no blocks behind what moves.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "bloom/bloom_shared.h"

/// Whether texels are fetched one by one: devices need not filter images of 32-bit floats.
layout(constant_id = 0) const bool kFetchesTexels = false;

layout(local_size_x = 8, local_size_y = 8) in;
layout(push_constant, scalar) uniform Push { BloomParams params; };
layout(binding = 0) uniform sampler2D uSource;
layout(binding = 1, rgba16f) uniform writeonly image2D uHalf;

/// Mean of the four texels that meet at a corner. \param corner in texels of the source
vec3 fetchCorner(vec2 corner) {
    vec2 size = vec2(params.sourcePx);
    if (!kFetchesTexels) return textureLod(uSource, corner / size, 0.0f).rgb;
    vec3 sum = vec3(0.0f);
    for (uint i = 0u; i < 4u; ++i) {
        vec2 texel = corner + vec2(i & 1u, i >> 1u) - 0.5f;
        sum += textureLod(uSource, clamp(texel, vec2(0.5f), size - 0.5f) / size, 0.0f).rgb;
    }
    return 0.25f * sum;
}

void main() {
    uvec2 pixel = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(pixel, params.sizePx))) return;
    // Where four texels meet, whatever the sizes: anywhere else the taps would weigh the texels of a
    // chessboard's black squares more than those of the white ones, and light would flicker as it moves.
    vec2 middle = 2.0f * vec2(pixel) + 1.0f;
    vec3 sum = 4.0f * fetchCorner(middle);
    for (uint i = 0u; i < 4u; ++i) {
        vec2 side = vec2(float(i & 1u), float(i >> 1u)) * 2.0f - 1.0f;
        sum += 4.0f * fetchCorner(middle + side);        // the inner box
        sum += 1.0f * fetchCorner(middle + 2.0f * side); // corners of the outer ones
    }
    sum += 2.0f * fetchCorner(middle + vec2(-2.0f, 0.0f));
    sum += 2.0f * fetchCorner(middle + vec2(2.0f, 0.0f));
    sum += 2.0f * fetchCorner(middle + vec2(0.0f, -2.0f));
    sum += 2.0f * fetchCorner(middle + vec2(0.0f, 2.0f));
    imageStore(uHalf, ivec2(pixel), vec4(sum / 32.0f, 1.0f));
}
