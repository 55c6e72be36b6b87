// SPDX-License-Identifier: MIT
// Puts the blended surfaces of one part of the exposure over what lies behind them in that part, and adds
// that to the sum of the parts before; the last part's sum is the picture.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "common/instant_surfaces.glsl"
#include "common/numeric.glsl"
#include "motion_blur/composite_shared.h"
#include "motion_blur/motion_blur_shared.h"

layout(constant_id = 0) const bool kHasParts = false; // colours of parts are known

layout(local_size_x = kGroupSize, local_size_y = kGroupSize) in;
layout(push_constant, scalar) uniform Push { CompositeParams params; };

layout(binding = 0) uniform sampler2D uBlendedColor;
layout(binding = 1) uniform sampler2D uBlendedOpacity;
layout(binding = 2, rgba16f) uniform image2D uPicture;
layout(binding = 3, rgba16f) uniform image2D uSum;
layout(binding = 4, scalar) readonly buffer Surfaces {
    InstantSurfaces uHead;
    uint uWords[];
};

/// rgb: mean colour of a part; a: of how many instants.
vec4 colorOfPart(uint part, uvec2 at) {
    uint word = surfacePartWord(uHead, part, at);
    return vec4(unpackHalf2x16(uWords[word]), unpackHalf2x16(uWords[word + 1u]));
}

/// What lies behind in the part. The picture is the mean of the parts, whatever it was made of: it may know
/// more of them than was looked up.
vec3 behind(vec3 picture, uvec2 at) {
    if (!kHasParts) return picture;
    vec4 sum = vec4(0.0f);
    for (uint part = 0u; part < params.partCount; ++part) {
        vec4 color = colorOfPart(part, at);
        sum += vec4(color.rgb * color.a, color.a);
    }
    vec4 own = colorOfPart(params.part, at);
    if (own.a == 0.0f) return picture;
    return max(own.rgb + (picture - sum.rgb / sum.a), vec3(0.0f));
}

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(uvec2(at), params.sizePx))) return;
    ivec2 pixel = at + ivec2(params.originPx);
    vec4 blended = texelFetch(uBlendedColor, at, 0);
    float opacity = params.isOpacityInAlpha != 0u ? blended.a : texelFetch(uBlendedOpacity, at, 0).r;
    vec4 picture = imageLoad(uPicture, pixel);
    vec3 color = blended.rgb + max(params.share - opacity, 0.0f) * behind(picture.rgb, uvec2(at));
    if (params.part > 0u) color += imageLoad(uSum, at).rgb;
    if (params.part + 1u < params.partCount)
        imageStore(uSum, at, vec4(color, 1.0f));
    else
        imageStore(uPicture, pixel, vec4(min(color, vec3(kMaxColor)), picture.a));
}
