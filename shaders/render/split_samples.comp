// SPDX-License-Identifier: MIT
// Splits the samples of each pixel into its own surface, which is the one that covers most of them,
// and the one that covers most of the others. What moves alike counts as one surface.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "render/split_samples_shared.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(push_constant, scalar) uniform Push { SplitParams params; };
layout(binding = 0) uniform sampler2DMS uColorSamples;
layout(binding = 1) uniform sampler2DMS uNormalSamples;
layout(binding = 2) uniform sampler2DMS uMotionDepthSamples;
layout(binding = 3) uniform usampler2DMS uEntityIdSamples;
layout(binding = 4, rgba16f) uniform writeonly image2D uColor;
layout(binding = 5, rgba16f) uniform writeonly image2D uNormal;
layout(binding = 6, rgba32f) uniform writeonly image2D uMotionDepth;
layout(binding = 7, r32ui) uniform writeonly uimage2D uEntityId;
layout(binding = 8, rgba32ui) uniform writeonly uimage2D uEdgeSurface;

/// Surfaces whose motion differs by less count as one: the mean of their colours moves with both.
const float kApartPx = 0.25f;

bool isSame(vec3 motionDepthA, vec3 motionDepthB) {
    return distance(motionDepthA.xy, motionDepthB.xy) < kApartPx;
}

/// A bit for each of the samples that are of the surface which covers most of them; of two that cover
/// as many, the nearer.
/// \param among a bit for each sample that counts, at least one
uint findMost(vec3 motionDepths[kSampleCount], uint among) {
    uint most = 0u;
    float depth = 0.0f;
    for (uint i = 0u; i < kSampleCount; ++i) {
        if ((among >> i & 1u) == 0u) continue;
        uint same = 0u;
        for (uint j = 0u; j < kSampleCount; ++j)
            if ((among >> j & 1u) != 0u && (i == j || isSame(motionDepths[i], motionDepths[j])))
                same |= 1u << j;
        bool isNearer = bitCount(same) == bitCount(most) && motionDepths[i].z < depth;
        if (bitCount(same) <= bitCount(most) && !isNearer) continue;
        most = same;
        depth = motionDepths[i].z;
    }
    return most;
}

/// A sample of the entity that covers most of the samples; of two that cover as many, the nearer.
/// \param among a bit for each sample that counts, at least one
int findEntity(ivec2 pixel, vec3 motionDepths[kSampleCount], uint among) {
    int found = findLSB(among);
    uint most = 0u;
    for (uint i = 0u; i < kSampleCount; ++i) {
        if ((among >> i & 1u) == 0u) continue;
        uint id = texelFetch(uEntityIdSamples, pixel, int(i)).x;
        uint count = 0u;
        for (uint j = 0u; j < kSampleCount; ++j)
            if ((among >> j & 1u) != 0u && texelFetch(uEntityIdSamples, pixel, int(j)).x == id)
                ++count;
        bool isNearer = count == most && motionDepths[i].z < motionDepths[found].z;
        if (count <= most && !isNearer) continue;
        most = count;
        found = int(i);
    }
    return found;
}

/// \param among a bit for each sample that counts, at least one
vec4 meanColor(ivec2 pixel, uint among) {
    vec4 sum = vec4(0.0f);
    for (uint i = 0u; i < kSampleCount; ++i)
        if ((among >> i & 1u) != 0u) sum += texelFetch(uColorSamples, pixel, int(i));
    return sum / float(bitCount(among));
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(uvec2(pixel), params.sizePx))) return;
    const uint kAll = (1u << kSampleCount) - 1u;
    vec3 motionDepths[kSampleCount];
    bool isWhole = true; // one triangle covers all samples: they are alike
    for (uint i = 0u; i < kSampleCount; ++i) {
        motionDepths[i] = texelFetch(uMotionDepthSamples, pixel, int(i)).xyz;
        isWhole = isWhole && motionDepths[i] == motionDepths[0];
    }
    uint own = isWhole ? kAll : findMost(motionDepths, kAll);
    uint others = params.keepsEdges != 0u ? kAll & ~own : 0u;
    if (others != 0u) {
        uint other = findMost(motionDepths, others);
        int first = findEntity(pixel, motionDepths, other);
        vec4 color = meanColor(pixel, other);
        imageStore(
            uEdgeSurface, pixel,
            uvec4(
                floatBitsToUint(motionDepths[first].z),
                texelFetch(uEntityIdSamples, pixel, first).x, packHalf2x16(color.rg),
                packHalf2x16(vec2(color.b, 0.0f))
            )
        );
    }
    // Blended surfaces have colours alone.
    bool isOne = isWhole && params.hasBlended == 0u;
    int first = isWhole ? 0 : findEntity(pixel, motionDepths, own);
    uint shown = kAll & ~others;
    imageStore(uColor, pixel, meanColor(pixel, isOne ? 1u : shown));
    imageStore(uNormal, pixel, texelFetch(uNormalSamples, pixel, first));
    imageStore(uMotionDepth, pixel, vec4(motionDepths[first], float(others)));
    imageStore(uEntityId, pixel, texelFetch(uEntityIdSamples, pixel, first));
}
