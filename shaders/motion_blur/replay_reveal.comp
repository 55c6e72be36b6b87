// SPDX-License-Identifier: MIT
// Writes the reveal's answers from a dump.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#include "motion_blur/dump.glsl"
#include "motion_blur/motion_blur_shared.h"

layout(local_size_x = kGroupSize, local_size_y = kGroupSize) in;
layout(push_constant, scalar) uniform Push {
    uvec2 sizePx;
    uvec2 color; // addresses
    uvec2 motionDepth;
    uvec2 entityId;
} params;
layout(binding = 0, rgba16f) uniform writeonly image2D uColor;
layout(binding = 1, rgba32f) uniform writeonly image2D uMotionDepth;
layout(binding = 2, r32ui) uniform writeonly uimage2D uEntityId;

void main() {
    uvec2 pixel = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(pixel, params.sizePx))) return;
    uint index = pixel.y * params.sizePx.x + pixel.x;
    ivec2 at = ivec2(pixel);
    DumpWords color = DumpWords(params.color);
    imageStore(
        uColor,
        at,
        vec4(
            unpackHalf2x16(color.words[2u * index]), unpackHalf2x16(color.words[2u * index + 1u])
        )
    );
    DumpWords motion = DumpWords(params.motionDepth);
    vec4 value;
    for (uint i = 0u; i < 4u; ++i)
        value[i] = uintBitsToFloat(motion.words[4u * index + i]);
    imageStore(uMotionDepth, at, value);
    imageStore(uEntityId, at, uvec4(DumpWords(params.entityId).words[index]));
}
