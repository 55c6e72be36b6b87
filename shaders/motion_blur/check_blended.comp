// SPDX-License-Identifier: MIT
// Totals of the layer that a host composites over the blurred picture.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "common/numeric.glsl"
#include "motion_blur/check_shared.h"
#include "motion_blur/motion_blur_shared.h"
#include "motion_blur/prepare_shared.h"

layout(local_size_x = kGroupSize, local_size_y = kGroupSize) in;
layout(push_constant, scalar) uniform Push {
    uvec2 sizePx;
    PrepareArea area;
} params;
layout(binding = 0) uniform sampler2D uBlended;
layout(binding = 1, scalar) buffer Totals { CheckTotals totals; };

// A half float's rounding above 1, as sums of shares have it.
const float kMaxOpacity = 1.001f;

void main() {
    uvec2 pixel = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(pixel, params.sizePx))) return;
    vec2 place = vec2(pixel) + 0.5f;
    vec4 texel = textureLod(uBlended, params.area.origin + place * params.area.perPixel, 0.0f);
    bool isKnown = isFinite(texel.r) && isFinite(texel.g) && isFinite(texel.b) && isFinite(texel.a);
    if (!isKnown) {
        atomicAdd(totals.counts[kCheckBlendedNan], 1u);
        return;
    }
    if (any(lessThan(texel.rgb, vec3(0.0f)))) atomicAdd(totals.counts[kCheckBlendedNegative], 1u);
    if (texel.a < 0.0f || texel.a > kMaxOpacity) atomicAdd(totals.counts[kCheckBlendedOpacity], 1u);
}
