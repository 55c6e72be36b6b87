// SPDX-License-Identifier: MIT
// Part of a host's image of entity ids, of 8 to 32 bits, as the motion blur reads them.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "motion_blur/motion_blur_shared.h"
#include "motion_blur/prepare_shared.h"
#include "render/scene_shared.h"

layout(local_size_x = kGroupSize, local_size_y = kGroupSize) in;
layout(push_constant, scalar) uniform Push {
    uvec2 sizePx;
    PrepareArea area;
    uint noneValue; // of the sky, in the host's image
} params;
layout(binding = 0) uniform usampler2D uIds;
layout(binding = 1, r32ui) uniform writeonly uimage2D uEntityId;

void main() {
    uvec2 pixel = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(pixel, params.sizePx))) return;
    vec2 place = vec2(pixel) + 0.5f;
    uint id = textureLod(uIds, params.area.origin + place * params.area.perPixel, 0.0f).x;
    if (id == params.noneValue) id = kNoEntity;
    imageStore(uEntityId, ivec2(pixel), uvec4(id));
}
