// SPDX-License-Identifier: MIT
// The longest motion of each entity's pixels. Lengths that are not negative compare as their bits do.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "render/longest_motion_shared.h"

layout(local_size_x = kLongestMotionGroup, local_size_y = kLongestMotionGroup) in;
layout(push_constant, scalar) uniform Push { LongestMotionParams params; };
layout(binding = 0) uniform sampler2D uMotionDepth;
layout(binding = 1) uniform usampler2D uEntityId;
// bits of pixels, one per row, the sky's last
layout(binding = 2, scalar) coherent buffer Longest { uint uLongest[]; };

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(uvec2(pixel), params.sizePx))) return;
    float speed = length(texelFetch(uMotionDepth, pixel, 0).xy);
    if (!(speed > 0.0f)) return; // still, or NaN
    uint row = min(texelFetch(uEntityId, pixel, 0).x, params.rowCount);
    uint bits = floatBitsToUint(speed);
    // Few pixels are longer than all before them, and only those need the atomic.
    if (bits > uLongest[row]) atomicMax(uLongest[row], bits);
}
