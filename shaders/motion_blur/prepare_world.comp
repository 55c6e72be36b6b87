// SPDX-License-Identifier: MIT
// Entity ids for a host without any, in whose world nothing moves by itself: one for all that is
// drawn, and none for the sky.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "motion_blur/motion_blur_shared.h"
#include "render/scene_shared.h"

layout(local_size_x = kGroupSize, local_size_y = kGroupSize) in;
layout(push_constant, scalar) uniform Push { uvec2 sizePx; } params;
layout(binding = 0) uniform sampler2D uMotionDepth;
layout(binding = 1, r32ui) uniform writeonly uimage2D uEntityId;

void main() {
    uvec2 pixel = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(pixel, params.sizePx))) return;
    vec2 place = (vec2(pixel) + 0.5f) / vec2(params.sizePx);
    float metres = textureLod(uMotionDepth, place, 0.0f).z;
    imageStore(uEntityId, ivec2(pixel), uvec4(metres >= kSkyDepth ? kNoEntity : 0u));
}
