// SPDX-License-Identifier: MIT
// The edges of edge_test.glsl in blocks that may be masked: 1 in a picture cleared to 0, and 1 in
// each block that has one within a block's length, so that the range check can pass over the rest.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "motion_blur/hybrid_shared.h"
#include "motion_blur/motion_blur_shared.h"
#define SHUTTER_BLOCK_LIST_BINDING 5
#include "motion_blur/block_list.glsl"

layout(local_size_x = kGroupSize, local_size_y = kGroupSize) in;
layout(push_constant, scalar) uniform Push {
    MotionBlurParams params;
    HybridParams method;
};
layout(binding = 0) uniform sampler2D uMotionDepth;
layout(binding = 1) uniform sampler2D uNormal;
layout(binding = 2) uniform usampler2D uEntityId;
layout(binding = 3, r8) uniform writeonly image2D uEdge;
layout(binding = 4, r8) uniform writeonly image2D uEdgeBlocks;

#include "motion_blur/edge_test.glsl"

void main() {
    ivec2 pixel;
    if (!findPixel(params.sizePx, pixel)) return;
    vec2 centre = vec2(pixel) + 0.5f;
    if (!isCandidate(centre) || measureEdge(centre) <= method.edgeThreshold) return;
    imageStore(uEdge, pixel, vec4(1.0f));
    ivec2 block = pixel / int(kGroupSize);
    ivec2 last = ivec2(params.sizePx - 1u) / int(kGroupSize);
    ivec2 first = max(block - 1, ivec2(0));
    for (int y = first.y; y <= min(block.y + 1, last.y); ++y)
        for (int x = first.x; x <= min(block.x + 1, last.x); ++x)
            imageStore(uEdgeBlocks, ivec2(x, y), vec4(1.0f));
}
