// SPDX-License-Identifier: MIT
// A host's entity ids for a dump.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#include "motion_blur/dump.glsl"
#include "motion_blur/dump_shared.h"
#include "motion_blur/motion_blur_shared.h"

layout(local_size_x = kGroupSize, local_size_y = kGroupSize) in;
layout(push_constant, scalar) uniform Push {
    uvec2 sizePx;
    uvec2 target;
    uint texels;
} params;
layout(binding = 0) uniform usampler2D uImage;

void main() {
    uvec2 pixel = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(pixel, params.sizePx))) return;
    DumpWords target = DumpWords(params.target);
    target.words[pixel.y * params.sizePx.x + pixel.x] = texelFetch(uImage, ivec2(pixel), 0).x;
}
