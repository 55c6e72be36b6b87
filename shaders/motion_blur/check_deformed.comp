// SPDX-License-Identifier: MIT
// Samples of where a host's deforming surfaces go.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "motion_blur/check_grid.glsl"
#include "motion_blur/motion_blur_shared.h"
#include "motion_blur/prepare_shared.h"

layout(local_size_x = kGroupSize, local_size_y = kGroupSize) in;
layout(push_constant, scalar) uniform Push {
    uvec2 sizePx;
    PrepareArea area;
} params;
layout(binding = 0) uniform sampler2D uMotion;
layout(binding = 1, scalar) buffer Totals { CheckTotals totals; };

void main() {
    // A sample for each of the first threads of the picture.
    uvec2 count = gl_NumWorkGroups.xy * kGroupSize;
    uint first = gl_GlobalInvocationID.y * count.x + gl_GlobalInvocationID.x;
    for (uint at = first; at < kCheckSamples; at += count.x * count.y) {
        uvec2 cell = uvec2(at % kCheckAcross, at / kCheckAcross);
        vec2 place = vec2(checkedPixel(cell, params.sizePx)) + 0.5f;
        totals.samples[at].deformed =
            textureLod(uMotion, params.area.origin + place * params.area.perPixel, 0.0f);
    }
}
