// SPDX-License-Identifier: MIT
// A host's motion vectors and depth, each in its own image, size and convention, as the one image
// that the motion blur reads.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#include "motion_blur/motion_blur_shared.h"
#include "motion_blur/prepare.glsl"

layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer PrepareRef {
    PrepareTable value;
};

layout(local_size_x = kGroupSize, local_size_y = kGroupSize) in;
layout(push_constant, scalar) uniform Push {
    uvec2 sizePx;
    uvec2 table; // address of a PrepareTable
} params;
layout(binding = 0) uniform sampler2D uVectors;
layout(binding = 1) uniform sampler2D uDepth;
layout(binding = 2) uniform sampler2D uBlurScale;
layout(binding = 3, rgba32f) uniform writeonly image2D uMotionDepth;

void main() {
    uvec2 pixel = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(pixel, params.sizePx))) return;
    PrepareTable table = PrepareRef(params.table).value;
    vec2 place = vec2(pixel) + 0.5f;
    vec2 vector = vec2(0.0f);
    if (prepareHas(table, kPrepareHasVectors))
        vector = textureLod(uVectors, placeInArea(table.vectors, place), 0.0f).xy;
    vec4 texel = textureLod(uDepth, placeInArea(table.depth, place), 0.0f);
    float value = prepareHas(table, kPrepareDepthIsThird) ? texel.z : texel.x;
    float blurScale = 1.0f;
    if (prepareHas(table, kPrepareHasBlurScale))
        blurScale = saturate(textureLod(uBlurScale, placeInArea(table.blurScale, place), 0.0f).x);
    float metres = metresOfDepth(table, value);
    bool isOwn = isViewModel(table, value);
    vec2 motion = preparedMotion(table, place, vector, metres, isOwn, blurScale);
    imageStore(uMotionDepth, ivec2(pixel), vec4(motion, metres, 0.0f));
}
