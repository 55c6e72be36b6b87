// SPDX-License-Identifier: MIT
// Counts taps in blocks of mixed motion within reach of which all depths are about the same.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "motion_blur/motion_blur_shared.h"
#define SHUTTER_BLOCK_LIST_BINDING 4
#include "motion_blur/block_list.glsl"

layout(local_size_x = kGroupSize, local_size_y = kGroupSize) in;
layout(push_constant, scalar) uniform Push { MotionBlurParams params; };
layout(binding = 0) uniform sampler2D uColor;
layout(binding = 1) uniform sampler2D uMotionDepth;
layout(binding = 2) uniform usampler2D uEntityId;
layout(binding = 3, rgba16f) uniform writeonly image2D uBlurred;

#include "motion_blur/count_alone.glsl"

void main() {
    ivec2 pixel;
    if (!findPixel(params.sizePx, pixel)) return;
    imageStore(uBlurred, pixel, vec4(countAlone(surfaceInRaster(vec2(pixel) + 0.5f)), 1.0f));
}
