// SPDX-License-Identifier: MIT
// A host's answers to the reveal, for a dump; only requested pixels are valid.
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
    uvec2 color; // addresses
    uvec2 motionDepth;
    uvec2 entityId;
} params;
layout(binding = 0, rgba16f) uniform readonly image2D uColor;
layout(binding = 1, rgba32f) uniform readonly image2D uMotionDepth;
layout(binding = 2, r32ui) uniform readonly uimage2D uEntityId;

void main() {
    uvec2 pixel = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(pixel, params.sizePx))) return;
    uint index = pixel.y * params.sizePx.x + pixel.x;
    ivec2 at = ivec2(pixel);
    dumpHalf4(DumpWords(params.color), index, imageLoad(uColor, at));
    dumpFloats(DumpWords(params.motionDepth), index, 4u, imageLoad(uMotionDepth, at));
    DumpWords(params.entityId).words[index] = imageLoad(uEntityId, at).x;
}
