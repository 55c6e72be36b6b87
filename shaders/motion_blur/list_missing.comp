// SPDX-License-Identifier: MIT
// The ray mask of the counts: lists pixels with missing taps for the reveal, in blocks that have some.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "motion_blur/hybrid_shared.h"
#include "motion_blur/motion_blur_shared.h"
#define SHUTTER_BLOCK_LIST_BINDING 2
#include "motion_blur/block_list.glsl"

layout(local_size_x = kGroupSize, local_size_y = kGroupSize) in;
layout(push_constant, scalar) uniform Push {
    MotionBlurParams params;
    HybridParams method;
};
layout(binding = 0) uniform usampler2D uMissing;
layout(binding = 1, r8) uniform writeonly image2D uMask;
layout(binding = 3, scalar) buffer MaskList {
    MaskHeader header;
    uint pixels[];
} uMasked;
layout(binding = 4, scalar) buffer Arguments { DispatchArguments uReveal; };

bool isMasked(ivec2 pixel) {
    vec2 uv = (vec2(pixel) + 0.5f) / vec2(params.sizePx);
    return textureLod(uMissing, uv, 0.0f).x != 0u;
}

void markBlock(uvec2 block) {} // it is in the list

#include "motion_blur/mask_list.glsl"

void main() {
    ivec2 pixel;
    bool isInside = findPixel(params.sizePx, pixel);
    if (kListTogether == 0u && !isInside) return;
    listMasked(pixel, isInside, method.rayShare);
}
