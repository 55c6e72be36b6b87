// SPDX-License-Identifier: MIT
// Half of the resolution, by the 13 taps of Jimenez 2014 ("Next Generation Post Processing in Call
// of Duty: Advanced Warfare"), which leave no blocks behind movers.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "bloom/bloom.glsl"
#include "bloom/bloom_shared.h"

const int kGroup = 8;
const int kTile = 2 * kGroup + 4; // two texels more on each side

layout(local_size_x = kGroup, local_size_y = kGroup) in;
layout(push_constant, scalar) uniform Push { BloomParams params; };
layout(binding = 0) uniform sampler2D uSource; // nearest
layout(binding = 1, rgba16f) uniform writeonly image2D uHalf;

/// The group's part of the source. Texels are fetched one by one, as the threshold is one of texels
/// and not of their means.
shared vec3 tile[kTile * kTile];
shared uint litThreads; // not 0: the tile has light

/// \return whether any of the thread's texels has light
bool fillTile() {
    ivec2 corner = 2 * kGroup * ivec2(gl_WorkGroupID.xy) - 2;
    ivec2 last = ivec2(params.sourcePx) - 1;
    bool isLit = false;
    for (uint i = gl_LocalInvocationIndex; i < uint(kTile * kTile); i += uint(kGroup * kGroup)) {
        ivec2 texel = clamp(corner + ivec2(i % kTile, i / kTile), ivec2(0), last);
        vec3 color = texelFetch(uSource, texel, 0).rgb;
        tile[i] = findHighlight(color, params.threshold, params.knee);
        isLit = isLit || tile[i] != vec3(0.0f);
    }
    return isLit;
}

/// The 13 taps are means of the four texels that meet at a corner: of the inner box's corners, and of
/// those of the four outer boxes. In texels they are a sum of two kernels that are products of a row
/// and a column: 1 1 2 2 1 1, and four times 0 1 1 1 1 0.
vec3 filterTile(uvec2 local) {
    vec3 sum = vec3(0.0f);
    for (uint y = 0u; y < 6u; ++y) {
        uint at = (2u * local.y + y) * kTile + 2u * local.x;
        vec3 middle = tile[at + 2u] + tile[at + 3u];
        vec3 sides = tile[at + 1u] + tile[at + 4u];
        float outer = y == 2u || y == 3u ? 2.0f : 1.0f;
        float inner = y == 0u || y == 5u ? 0.0f : 4.0f;
        sum += (2.0f * outer + inner) * middle + (outer + inner) * sides;
        sum += outer * (tile[at] + tile[at + 5u]);
    }
    return sum / 128.0f;
}

void main() {
    if (gl_LocalInvocationIndex == 0u) litThreads = 0u;
    barrier();
    if (fillTile()) atomicOr(litThreads, 1u);
    barrier();
    uvec2 pixel = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(pixel, params.sizePx))) return;
    // Most of a picture is no highlight: nothing filtered is nothing.
    vec3 light = vec3(0.0f);
    if (litThreads != 0u) light = filterTile(gl_LocalInvocationID.xy);
    imageStore(uHalf, ivec2(pixel), vec4(light, 1.0f));
}
