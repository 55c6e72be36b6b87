// SPDX-License-Identifier: MIT
// Gives the pixels of a host's view model a row of their own, by their depth.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#include "motion_blur/motion_blur_shared.h"
#include "motion_blur/prepare.glsl"

layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer PrepareRef {
    PrepareTable value;
};

layout(local_size_x = kGroupSize, local_size_y = kGroupSize) in;
layout(push_constant, scalar) uniform Push {
    uvec2 sizePx;
    uvec2 table; // address of a PrepareTable
    uint row;
} params;
layout(binding = 0) uniform usampler2D uIds; // as the motion blur reads them
layout(binding = 1) uniform sampler2D uDepth;
layout(binding = 2, r32ui) uniform writeonly uimage2D uEntityId;

void main() {
    uvec2 pixel = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(pixel, params.sizePx))) return;
    PrepareTable table = PrepareRef(params.table).value;
    vec2 place = vec2(pixel) + 0.5f;
    uint id = textureLod(uIds, place / vec2(params.sizePx), 0.0f).x;
    // A row that the host does not have is unresolved, and stays so.
    if (id == params.row) id = params.row + 1u;
    float value = textureLod(uDepth, placeInArea(table.depth, place), 0.0f).x;
    if (isViewModel(table, value)) id = params.row;
    imageStore(uEntityId, ivec2(pixel), uvec4(id));
}
