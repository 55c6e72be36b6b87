// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "tonemap/tonemap.glsl"
#include "tonemap/tonemap_shared.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(push_constant, scalar) uniform Push { TonemapParams params; };
layout(binding = 0) uniform sampler2D uColor;
layout(binding = 1, rgba8) uniform writeonly image2D uDisplay;

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(uvec2(pixel), params.sizePx))) return;
    vec3 color = texelFetch(uColor, pixel, 0).rgb * params.gain;
    if (params.operator_ == kTonemapNeutral) color = toneMapNeutral(color);
    imageStore(uDisplay, pixel, vec4(encodeSrgb3(color), 1.0f));
}
