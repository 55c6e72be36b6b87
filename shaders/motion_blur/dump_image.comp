// SPDX-License-Identifier: MIT
// An image of a host, as it is, for a dump.
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
    uvec2 sizePx; // of the image
    uvec2 target; // address of its texels
    uint texels;  // kDumpHalf4 ...
} params;
layout(binding = 0) uniform sampler2D uImage;

void main() {
    uvec2 pixel = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(pixel, params.sizePx))) return;
    vec4 value = texelFetch(uImage, ivec2(pixel), 0);
    uint index = pixel.y * params.sizePx.x + pixel.x;
    DumpWords target = DumpWords(params.target);
    if (params.texels == kDumpHalf4)
        dumpHalf4(target, index, value);
    else
        dumpFloats(target, index, params.texels, value);
}
