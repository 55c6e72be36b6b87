// SPDX-License-Identifier: MIT
// Gather of one layer, the raster's, in blocks of mixed motion without masked pixels.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "motion_blur/gather_shared.h"
#include "motion_blur/motion_blur_shared.h"
#define SHUTTER_BLOCK_LIST_BINDING 4
#include "motion_blur/block_list.glsl"

layout(constant_id = 1) const uint kSkipMasked = 0u; // 1: over candidates, of which some are masked

layout(local_size_x = kGroupSize, local_size_y = kGroupSize) in;
layout(push_constant, scalar) uniform Push {
    MotionBlurParams params;
    GatherParams method;
};
layout(binding = 0) uniform sampler2D uColor;
layout(binding = 1) uniform sampler2D uMotionDepth;
layout(binding = 2) uniform sampler2D uDominant;
layout(binding = 3, rgba16f) uniform writeonly image2D uBlurred;

#include "motion_blur/gather_layer.glsl"

void main() {
    ivec2 pixel;
    if (!findPixel(params.sizePx, pixel)) return;
    if (kSkipMasked != 0u && isMaskedBlock(params.sizePx, uvec2(pixel) / kGroupSize)) return;
    vec2 centre = vec2(pixel) + 0.5f;
    vec2 dominant = dominantAt(uDominant, centre);
    // Nothing moves within reach: the sharp colour, bit for bit.
    if (length(dominant) < kStillPx) {
        vec2 uv = centre / vec2(params.sizePx);
        imageStore(uBlurred, pixel, textureLod(uColor, uv, 0.0f));
        return;
    }
    Gathered front = gatherRaster(dominant, centre);
    imageStore(uBlurred, pixel, vec4(front.sum / front.weight, 1.0f));
}
