// SPDX-License-Identifier: MIT
// The revealed layer as whole pictures, for debug views: what rays found in the mask, the raster
// elsewhere.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "motion_blur/motion_blur_shared.h"

layout(local_size_x = kGroupSize, local_size_y = kGroupSize) in;
layout(push_constant, scalar) uniform Push { MotionBlurParams params; };
layout(binding = 0) uniform sampler2D uMask;
layout(binding = 1) uniform sampler2D uColor;
layout(binding = 2) uniform sampler2D uMotionDepth;
layout(binding = 3) uniform sampler2D uRevealColor;
layout(binding = 4) uniform sampler2D uRevealMotionDepth;
layout(binding = 5, rgba16f) uniform writeonly image2D uColorView;
layout(binding = 6, rgba32f) uniform writeonly image2D uMotionDepthView;

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(uvec2(pixel), params.sizePx))) return;
    vec2 uv = (vec2(pixel) + 0.5f) / vec2(params.sizePx);
    if (textureLod(uMask, uv, 0.0f).x > 0.5f) {
        imageStore(uColorView, pixel, textureLod(uRevealColor, uv, 0.0f));
        imageStore(uMotionDepthView, pixel, textureLod(uRevealMotionDepth, uv, 0.0f));
    } else {
        imageStore(uColorView, pixel, textureLod(uColor, uv, 0.0f));
        imageStore(uMotionDepthView, pixel, textureLod(uMotionDepth, uv, 0.0f));
    }
}
