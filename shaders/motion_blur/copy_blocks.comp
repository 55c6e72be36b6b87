// SPDX-License-Identifier: MIT
// A list's blocks from one picture to another, bit for bit.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "motion_blur/motion_blur_shared.h"
#define SHUTTER_BLOCK_LIST_BINDING 2
#include "motion_blur/block_list.glsl"

layout(local_size_x = kGroupSize, local_size_y = kGroupSize) in;
layout(push_constant, scalar) uniform Push { MotionBlurParams params; };
layout(binding = 0) uniform sampler2D uSource;
layout(binding = 1, rgba16f) uniform writeonly image2D uTarget;

void main() {
    ivec2 pixel;
    if (!findPixel(params.sizePx, pixel)) return;
    vec2 uv = (vec2(pixel) + 0.5f) / vec2(params.sizePx);
    imageStore(uTarget, pixel, textureLod(uSource, uv, 0.0f));
}
