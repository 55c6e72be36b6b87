// SPDX-License-Identifier: MIT
// The blurred picture in the bits of a host's UNORM or sRGB image, row by row, for a copy: not every
// device has storage images of these formats.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#include "common/numeric.glsl"
#include "common/transfer.glsl"
#include "motion_blur/deliver_shared.h"
#include "motion_blur/motion_blur_shared.h"

layout(buffer_reference, scalar, buffer_reference_align = 4) writeonly buffer Words {
    uint words[];
};

layout(local_size_x = kGroupSize, local_size_y = kGroupSize) in;
layout(push_constant, scalar) uniform Push {
    uvec2 sizePx;
    uvec2 target; // address of the first word
    Transfer transfer;
    uint packing; // kPackRgba8 ...
} params;
layout(binding = 0) uniform sampler2D uPicture;

uint packTens(vec4 value) {
    uvec4 bits = uvec4(round(value * vec4(1023.0f, 1023.0f, 1023.0f, 3.0f)));
    return bits.x | bits.y << 10 | bits.z << 20 | bits.w << 30;
}

void main() {
    uvec2 pixel = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(pixel, params.sizePx))) return;
    vec4 picture = textureLod(uPicture, (vec2(pixel) + 0.5f) / vec2(params.sizePx), 0.0f);
    picture.rgb = colorOfLight(params.transfer, storableColor(picture.rgb));
    picture = clamp(picture, 0.0f, 1.0f);
    Words target = Words(params.target);
    uint index = pixel.y * params.sizePx.x + pixel.x;
    switch (params.packing) {
    case kPackRgba8:
        target.words[index] = packUnorm4x8(picture);
        break;
    case kPackBgra8:
        target.words[index] = packUnorm4x8(picture.bgra);
        break;
    case kPackRgb10a2:
        target.words[index] = packTens(picture);
        break;
    case kPackBgr10a2:
        target.words[index] = packTens(picture.bgra);
        break;
    default:
        target.words[2u * index] = packUnorm2x16(picture.rg);
        target.words[2u * index + 1u] = packUnorm2x16(picture.ba);
    }
}
