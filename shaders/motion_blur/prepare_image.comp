// SPDX-License-Identifier: MIT
// Copies part of a host's image, in any format that is sampled as floats, to a half-float image of
// light.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "common/numeric.glsl"
#include "common/transfer.glsl"
#include "motion_blur/motion_blur_shared.h"
#include "motion_blur/prepare_shared.h"

/// Colours that half floats cannot hold become ones that they can, and alpha 0 or more; normals have signs.
layout(constant_id = 0) const bool kIsColor = true;

layout(local_size_x = kGroupSize, local_size_y = kGroupSize) in;
layout(push_constant, scalar) uniform Push {
    uvec2 sizePx;
    PrepareArea area;
    Transfer transfer; // linear for normals
} params;
layout(binding = 0) uniform sampler2D uImage;
layout(binding = 1, rgba16f) uniform writeonly image2D uPicture;

void main() {
    uvec2 pixel = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(pixel, params.sizePx))) return;
    vec2 place = vec2(pixel) + 0.5f;
    vec4 value = textureLod(uImage, params.area.origin + place * params.area.perPixel, 0.0f);
    // A negative alpha is a radius of lens_filter.comp; no NaN passes.
    if (kIsColor) {
        vec3 light = lightOfColor(params.transfer, value.rgb);
        value = vec4(storableColor(light), value.a > 0.0f ? value.a : 0.0f);
    }
    imageStore(uPicture, ivec2(pixel), value);
}
