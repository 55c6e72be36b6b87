// SPDX-License-Identifier: MIT
// The mean over parts of the exposure of particles over the picture.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "common/numeric.glsl"
#include "common/particle_shared.h"

layout(push_constant, scalar) uniform Push { uint partCount; };
layout(binding = 0) uniform sampler2D uColor;
// Premultiplied, and the share that is seen through them; those beyond the count are not read.
layout(binding = 1) uniform sampler2D uPart0;
layout(binding = 2) uniform sampler2D uPart1;
layout(binding = 3) uniform sampler2D uPart2;
layout(binding = 4) uniform sampler2D uPart3;
layout(binding = 5) uniform sampler2D uPart4;
layout(binding = 6) uniform sampler2D uPart5;
layout(binding = 7) uniform sampler2D uPart6;
layout(binding = 8) uniform sampler2D uPart7;

layout(location = 0) out vec4 outColor;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 color = texelFetch(uColor, pixel, 0);
    vec4 sum = texelFetch(uPart0, pixel, 0);
    if (partCount > 1u) sum += texelFetch(uPart1, pixel, 0);
    if (partCount > 2u) sum += texelFetch(uPart2, pixel, 0);
    if (partCount > 3u) sum += texelFetch(uPart3, pixel, 0);
    if (partCount > 4u) sum += texelFetch(uPart4, pixel, 0);
    if (partCount > 5u) sum += texelFetch(uPart5, pixel, 0);
    if (partCount > 6u) sum += texelFetch(uPart6, pixel, 0);
    if (partCount > 7u) sum += texelFetch(uPart7, pixel, 0);
    vec4 mean = sum / float(partCount);
    // Where no particle is, not a bit changes.
    outColor = mean == vec4(0.0f, 0.0f, 0.0f, 1.0f)
                   ? color
                   : vec4(storableColor(mean.rgb + mean.a * color.rgb), color.a);
}
