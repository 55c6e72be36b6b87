// SPDX-License-Identifier: MIT
// The hosts' own rays: what a pixel's ray meets after the entity that it meets first.
#version 460

layout(local_size_x = 64) in;

layout(binding = 0) readonly buffer List {
    uint count;
    uint others[3];
    uint pixels[]; // x | y << 16
};
layout(binding = 1, rgba16f) uniform writeonly image2D uColor;
layout(binding = 2, rgba32f) uniform writeonly image2D uMotionDepth;
layout(binding = 3, r32ui) uniform writeonly uimage2D uEntityId;

layout(push_constant) uniform Square {
    vec2 leftTopPx; // now
    float sidePx;
    float metres;
    float wallMetres;
};

void main() {
    const uint index =
        (gl_WorkGroupID.y * 256u + gl_WorkGroupID.x) * 64u + gl_LocalInvocationIndex;
    if (index >= count)
        return;
    const ivec2 pixel = ivec2(pixels[index] & 0xFFFFu, pixels[index] >> 16);
    const vec2 size = vec2(imageSize(uColor));
    // The square as a quad in view space, and the ray through the pixel's centre.
    const vec2 edge = vec2(2.0, -2.0 * size.y / size.x) / size;
    const vec2 corner = vec2(-1.0, size.y / size.x);
    const vec3 ray = vec3((vec2(pixel) + 0.5) * edge + corner, -1.0);
    const vec2 hit = ray.xy * metres;
    const vec2 first = (leftTopPx * edge + corner) * metres;
    const vec2 last = ((leftTopPx + sidePx) * edge + corner) * metres;
    const bool meetsSquare =
        hit.x >= first.x && hit.x < last.x && hit.y <= first.y && hit.y > last.y;

    vec4 color = vec4(0.0, 0.0, 0.0, 1.0);
    vec4 motionDepth = vec4(0.0, 0.0, 1e9, 0.0);
    uint id = 0xFFFFFFFFu; // behind the wall lies the sky
    if (meetsSquare) {
        color = vec4(pixel.x / 8 % 2 == 1 ? 0.125 : 0.5, 0.25, 0.375, 1.0);
        motionDepth.z = wallMetres;
        id = 0u;
    }
    imageStore(uColor, pixel, color);
    imageStore(uMotionDepth, pixel, motionDepth);
    imageStore(uEntityId, pixel, uvec4(id));
}
