// SPDX-License-Identifier: MIT
// The mean over parts of the exposure of particles over the picture.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "common/instant_surfaces.glsl"
#include "common/numeric.glsl"
#include "particles/particle_shared.h"

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

layout(binding = 9, scalar) readonly buffer Surfaces {
    InstantSurfaces uHead;
    uint uWords[];
};

#include "common/surface_parts.glsl"

layout(constant_id = 0) const bool kReadsParts = false; // the background differs between the parts

layout(location = 0) out vec4 outColor;

vec4 fetchPart(uint part, ivec2 pixel) {
    switch (part) {
    case 0u: return texelFetch(uPart0, pixel, 0);
    case 1u: return texelFetch(uPart1, pixel, 0);
    case 2u: return texelFetch(uPart2, pixel, 0);
    case 3u: return texelFetch(uPart3, pixel, 0);
    case 4u: return texelFetch(uPart4, pixel, 0);
    case 5u: return texelFetch(uPart5, pixel, 0);
    case 6u: return texelFetch(uPart6, pixel, 0);
    default: return texelFetch(uPart7, pixel, 0);
    }
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    uvec2 at = uvec2(pixel) - uHead.originPx;
    bool readsParts = kReadsParts && all(lessThan(at, uHead.sizePx));
    vec4 color = texelFetch(uColor, pixel, 0);
    vec4 sum = vec4(0.0f);
    vec3 behind = vec3(0.0f); // of the parts' own, as much as is seen of it
    vec3 known = vec3(0.0f);  // sum of the parts' own
    for (uint part = 0u; part < partCount; ++part) {
        vec4 drawn = fetchPart(part, pixel);
        sum += drawn;
        if (!readsParts) continue;
        vec3 own = behindPart(part * uHead.partCount / partCount, at, color.rgb);
        behind += drawn.a * own;
        known += own;
    }
    vec4 mean = sum / float(partCount);
    // The difference between the picture and the mean of the parts.
    if (readsParts) behind = (behind + mean.a * (float(partCount) * color.rgb - known)) / float(partCount);
    else behind = mean.a * color.rgb;
    // Where no particle is, not a bit changes.
    outColor = mean == vec4(0.0f, 0.0f, 0.0f, 1.0f)
                   ? color
                   : vec4(storableColor(mean.rgb + behind), color.a);
}
