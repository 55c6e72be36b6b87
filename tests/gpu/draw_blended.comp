// SPDX-License-Identifier: MIT
// A host's own draws over the blurred picture: a pane that slides, against the depths of the instants as
// shutter_motion_blur.h describes them.
#version 460

layout(local_size_x = 8, local_size_y = 8) in;
layout(push_constant, std430) uniform Push {
    uvec2 sizePx; // of the area
    ivec2 originPx;
    uint firstInstant;
    uint partInstantCount;
    uint instantCount;
    uint hasSurfaces;
    uint isOpacityInAlpha;
    float times[16]; // of the part's instants
} push;
layout(binding = 0) readonly buffer Surfaces { uint uWords[]; };
layout(binding = 1, rgba16f) uniform writeonly image2D uColor;
layout(binding = 2, rgba16f) uniform writeonly image2D uOpacity;

const vec3 kPane = vec3(0.1f, 0.9f, 0.3f);
const float kAlpha = 0.5f;

float depthOf(uint instant, uvec2 at) {
    uint word = 8u + (instant / 2u) * push.sizePx.x * push.sizePx.y + at.y * push.sizePx.x + at.x;
    return unpackHalf2x16(uWords[word])[instant & 1u];
}

void main() {
    uvec2 at = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(at, push.sizePx))) return;
    vec2 place = vec2(ivec2(at) + push.originPx) + 0.5f;
    float sum = 0.0f;
    for (uint i = 0u; i < push.partInstantCount; ++i) {
        float inPane = place.x - (70.0f - 30.0f * push.times[i]);
        if (inPane < 0.0f || inPane >= 32.0f || place.y < 8.0f || place.y >= 40.0f) continue;
        float depth = place.y < 24.0f ? 3.0f : 7.0f; // before the square, behind it
        float seen = push.hasSurfaces != 0u ? depthOf(push.firstInstant + i, at) : 1.0e9f;
        if (depth < seen * 1.001f) sum += kAlpha / float(push.instantCount);
    }
    imageStore(uColor, ivec2(at), vec4(kPane * sum, push.isOpacityInAlpha != 0u ? sum : 0.0f));
    if (push.isOpacityInAlpha == 0u) imageStore(uOpacity, ivec2(at), vec4(sum, 0.0f, 0.0f, 0.0f));
}
