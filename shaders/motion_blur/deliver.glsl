// SPDX-License-Identifier: MIT
// The blurred picture into part of a host's image. SHUTTER_DELIVERED is that image's format.
#include "common/numeric.glsl"
#include "common/transfer.glsl"
#include "motion_blur/motion_blur_shared.h"

layout(local_size_x = kGroupSize, local_size_y = kGroupSize) in;
layout(push_constant, scalar) uniform Push {
    uvec2 sizePx;
    ivec2 offset; // of the part in the host's image
    Transfer transfer;
} params;
layout(binding = 0) uniform sampler2D uPicture;
layout(binding = 1, SHUTTER_DELIVERED) uniform writeonly image2D uImage;

void main() {
    uvec2 pixel = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(pixel, params.sizePx))) return;
    vec2 uv = (vec2(pixel) + 0.5f) / vec2(params.sizePx);
    vec4 picture = textureLod(uPicture, uv, 0.0f);
    picture.rgb = colorOfLight(params.transfer, picture.rgb);
    imageStore(uImage, ivec2(pixel) + params.offset, picture);
}
