// SPDX-License-Identifier: MIT
// Composites the blended surfaces of one part of the exposure over their background in that part,
// and adds the result to the sum of the earlier parts; the last part's sum is the picture.
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

#include "common/surface_parts.glsl"

/// The difference between the picture and the mean of the parts' colours.
vec3 findRest(vec3 picture, uvec2 at) {
    float shares[kMaxSurfaceParts];
    for (uint part = 0u; part < kMaxSurfaceParts; ++part) shares[part] = 0.0f;
    for (uint i = 0u; i < uHead.instantCount; ++i)
        shares[surfacePartOf(uHead, i)] += 1.0f / float(uHead.instantCount);
    vec3 rest = vec3(0.0f);
    for (uint part = 0u; part < params.partCount; ++part) {
        vec4 color = colorOfPart(part, at);
        if (color.a > 0.0f) rest += shares[part] * (picture - color.rgb);
    }
    return rest;
}

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(uvec2(at), params.sizePx))) return;
    ivec2 pixel = at + ivec2(params.originPx);
    vec4 blended = texelFetch(uBlendedColor, at, 0);
    float opacity = params.isOpacityInAlpha != 0u ? blended.a : texelFetch(uBlendedOpacity, at, 0).r;
    if (isNotANumber(opacity)) opacity = 0.0f;
    // Alpha of the sum: transmittance of the layer over all parts so far.
    float passed = clamp(params.share - opacity, 0.0f, params.share);
    bool isLast = params.part + 1u == params.partCount;
    vec3 picture = vec3(0.0f);
    vec3 behind = vec3(0.0f);
    if (kHasParts) {
        vec4 own = colorOfPart(params.part, uvec2(at));
        if (isLast || own.a == 0.0f) picture = imageLoad(uPicture, pixel).rgb;
        behind = own.a > 0.0f ? own.rgb : picture;
    } else {
        behind = picture = imageLoad(uPicture, pixel).rgb;
    }
    vec4 sum = vec4(storableColor(blended.rgb) + passed * behind, passed);
    if (params.part > 0u) sum += imageLoad(uSum, at);
    if (!isLast) {
        imageStore(uSum, at, sum);
        return;
    }
    if (kHasParts) sum.rgb += sum.a * findRest(picture, uvec2(at));
    imageStore(uPicture, pixel, vec4(storableColor(sum.rgb), 1.0f));
}
