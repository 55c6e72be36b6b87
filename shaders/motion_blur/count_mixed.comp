// SPDX-License-Identifier: MIT
// Counts taps over the raster's layer, in blocks of mixed motion without masked pixels.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "motion_blur/motion_blur_shared.h"
#define SHUTTER_BLOCK_LIST_BINDING 5
#include "motion_blur/block_list.glsl"

/// 1: over candidates of the mask, of which some are masked; 0: over blocks within reach of which all
/// depths are about the same.
layout(constant_id = 1) const uint kCandidates = 0u;

layout(local_size_x = kGroupSize, local_size_y = kGroupSize) in;
layout(push_constant, scalar) uniform Push { MotionBlurParams params; };
layout(binding = 0) uniform sampler2D uColor;
layout(binding = 1) uniform sampler2D uMotionDepth;
layout(binding = 2) uniform sampler2D uDominant;
layout(binding = 3) uniform usampler2D uEntityId;
layout(binding = 4, rgba16f) uniform writeonly image2D uBlurred;

#include "motion_blur/count_taps.glsl"

void main() {
    ivec2 pixel;
    if (!findPixel(params.sizePx, pixel)) return;
    if (kCandidates != 0u && isMaskedBlock(params.sizePx, uvec2(pixel) / kGroupSize)) return;
    vec2 centre = vec2(pixel) + 0.5f;
    vec2 dominant = dominantAt(centre);
    // Nothing moves within reach: the sharp colour, bit for bit.
    if (length(dominant) < kStillPx) {
        imageStore(uBlurred, pixel, textureLod(uColor, uvOf(centre), 0.0f));
        return;
    }
    imageStore(uBlurred, pixel, vec4(countRaster(dominant, centre, kCandidates == 0u), 1.0f));
}
