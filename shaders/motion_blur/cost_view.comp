// SPDX-License-Identifier: MIT
// Fetches of the filters for each pixel of a list's blocks, for the cost view.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "motion_blur/motion_blur_shared.h"
#define SHUTTER_BLOCK_LIST_BINDING 2
#include "motion_blur/block_list.glsl"

layout(constant_id = 1) const uint kFetchesPerTap = 1u;
layout(constant_id = 2) const uint kRayFetches = 0u; // 0: the list has no masked pixels

layout(local_size_x = kGroupSize, local_size_y = kGroupSize) in;
layout(push_constant, scalar) uniform Push { MotionBlurParams params; };
layout(binding = 0) uniform sampler2D uMask;
layout(binding = 1, r32f) uniform writeonly image2D uCost;

void main() {
    ivec2 pixel;
    if (!findPixel(params.sizePx, pixel)) return;
    float fetches = float(params.sampleCount * kFetchesPerTap);
    vec2 uv = (vec2(pixel) + 0.5f) / vec2(params.sizePx);
    if (kRayFetches > 0u && textureLod(uMask, uv, 0.0f).x > 0.5f) fetches += float(kRayFetches);
    imageStore(uCost, pixel, vec4(fetches, 0.0f, 0.0f, 0.0f));
}
