// SPDX-License-Identifier: MIT
// Writes the blurred picture for a dump, followed by the number that marks the frame as run.
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
    uint serial;
} params;
layout(binding = 0, rgba16f) uniform readonly image2D uPicture;

void main() {
    uvec2 pixel = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(pixel, params.sizePx))) return;
    DumpWords target = DumpWords(params.target);
    dumpHalf4(target, pixel.y * params.sizePx.x + pixel.x, imageLoad(uPicture, ivec2(pixel)));
    if (pixel == uvec2(0u)) target.words[2u * params.sizePx.x * params.sizePx.y] = params.serial;
}
