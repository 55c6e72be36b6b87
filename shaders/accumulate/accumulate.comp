// SPDX-License-Identifier: MIT
// Weighted sum of frames; the last one divides.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "accumulate/accumulate_shared.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(push_constant, scalar) uniform Push { AccumulateParams params; };
layout(binding = 0) uniform sampler2D uColor;
layout(binding = 1, rgba32f) uniform image2D uSum;

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(uvec2(pixel), params.sizePx))) return;
    vec4 sum = vec4(texelFetch(uColor, pixel, 0).rgb, 1.0f) * params.weight;
    if (params.clears == 0u) sum += imageLoad(uSum, pixel);
    imageStore(uSum, pixel, sum * params.scale);
}
