// SPDX-License-Identifier: MIT
// Third test of the ray mask, the range check: a moving pixel is masked when any sample along its
// motion is an edge. Masked pixels are also listed for the reveal, which is dispatched indirectly.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "motion_blur/motion_blur_shared.h"
#include "motion_blur/weights.glsl"

layout(local_size_x = kGroupSize, local_size_y = kGroupSize) in;
layout(push_constant, scalar) uniform Push { MotionBlurParams params; };
layout(binding = 0) uniform sampler2D uMotionDepth;
layout(binding = 1) uniform sampler2D uDominant;
layout(binding = 2) uniform sampler2D uEdge;
layout(binding = 3, r8) uniform writeonly image2D uMask;
layout(binding = 4, scalar) buffer MaskList {
    MaskHeader header;
    uint pixels[];
};
layout(binding = 5, scalar) buffer Arguments { RevealArguments arguments; };

/// Edges of a silhouette are two pixels wide (half the Sobel window): steps of at most one and a
/// half cannot jump over one.
const float kStepPx = 1.5f;

bool meetsEdge(vec2 centre, vec2 offset) {
    float range = length(offset);
    uint steps = uint(ceil(range / kStepPx));
    for (uint i = 0u; i <= steps; ++i) {
        vec2 at = centre + offset * (float(i) / float(max(steps, 1u)));
        if (textureLod(uEdge, at / vec2(params.sizePx), 0.0f).b > 0.5f) return true;
    }
    return false;
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(uvec2(pixel), params.sizePx))) return;
    vec2 centre = vec2(pixel) + 0.5f;
    bool masked = false;
    vec2 dominant =
        textureLod(uDominant, tileUv(centre, params.tileSizePx, params.tileCount), 0.0f).xy;
    if (length(dominant) >= kStillPx) {
        vec2 motion = textureLod(uMotionDepth, centre / vec2(params.sizePx), 0.0f).xy;
        motion = clampMotion(motion, float(params.tileSizePx));
        masked = length(motion) >= kStillPx &&
                 (meetsEdge(centre, motion * params.rasterShare) ||
                  meetsEdge(centre, motion * (params.rasterShare - 1.0f)));
    }
    imageStore(uMask, pixel, vec4(masked ? 1.0f : 0.0f));
    if (!masked) return;
    uint index = atomicAdd(header.maskedPixels, 1u);
    pixels[index] = uint(pixel.x) | uint(pixel.y) << 16;
    if (index % kRevealThreads == 0u) atomicAdd(arguments.groupsX, 1u);
}
