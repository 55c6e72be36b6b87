// SPDX-License-Identifier: MIT
#version 460
layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0, rgba16f) uniform image2D uColor;
layout(push_constant) uniform Push { float strength; };

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(uColor)))) return;
    vec2 offset = (vec2(pixel) + 0.5f) / vec2(imageSize(uColor)) - 0.5f;
    float light = max(1.0f - strength * 2.0f * dot(offset, offset), 0.0f);
    imageStore(uColor, pixel, imageLoad(uColor, pixel) * vec4(vec3(light), 1.0f));
}
