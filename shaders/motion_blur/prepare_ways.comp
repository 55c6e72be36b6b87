// SPDX-License-Identifier: MIT
// Where a host's deforming surfaces are at shutter open and close, by pixel, as the search reads it.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "common/pixel_way.glsl"
#include "motion_blur/motion_blur_shared.h"
#include "motion_blur/prepare.glsl"

layout(local_size_x = kGroupSize, local_size_y = kGroupSize) in;
layout(push_constant, scalar) uniform Push {
    uvec2 sizePx;
    PrepareArea area;
    float rasterTime; // shutter time of the raster that the pixels are of
} params;
layout(binding = 0) uniform sampler2D uMotion;
layout(binding = 1, rg32ui) uniform writeonly uimage2D uWays;

void main() {
    uvec2 pixel = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(pixel, params.sizePx))) return;
    vec2 place = vec2(pixel) + 0.5f;
    vec4 ends = textureLod(uMotion, params.area.origin + place * params.area.perPixel, 0.0f);
    imageStore(uWays, ivec2(pixel), uvec4(prepareWay(ends, params.rasterTime), 0u, 0u));
}
