// SPDX-License-Identifier: MIT
// Results of the ray mask's first two tests, for debug views: r: candidate, g: edge measure x_n, b:
// edge.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "motion_blur/hybrid_shared.h"
#include "motion_blur/motion_blur_shared.h"

layout(constant_id = 0) const uint kMeasureEverywhere = 0u; // x_n of every pixel, not candidates only

layout(local_size_x = kGroupSize, local_size_y = kGroupSize) in;
layout(push_constant, scalar) uniform Push {
    MotionBlurParams params;
    HybridParams method;
};
layout(binding = 0) uniform sampler2D uMotionDepth;
layout(binding = 1) uniform sampler2D uNormal;
layout(binding = 2) uniform usampler2D uEntityId;
layout(binding = 3, rgba8) uniform writeonly image2D uEdge;

#include "motion_blur/edge_test.glsl"

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(uvec2(pixel), params.sizePx))) return;
    vec2 centre = vec2(pixel) + 0.5f;
    bool candidate = isCandidate(centre);
    float measure = candidate || kMeasureEverywhere != 0u ? measureEdge(centre) : 0.0f;
    bool edge = candidate && measure > method.edgeThreshold;
    imageStore(uEdge, pixel, vec4(candidate ? 1.0f : 0.0f, measure, edge ? 1.0f : 0.0f, 0.0f));
}
