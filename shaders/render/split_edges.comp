// SPDX-License-Identifier: MIT
// Splits the samples of a pixel into its own surface, which is the one that covers most of them,
// and the one that covers most of the others. Surfaces with equal motion count as one.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "common/picture_space.glsl"
#include "render/split_samples.glsl"

layout(local_size_x = kSplitGroupSize) in;
layout(binding = 7, rgba32ui) uniform writeonly uimage2D uEdgeSurface;
layout(binding = 8, scalar) readonly buffer Edges {
    uint count;
    uint pixels[]; // x | y << 16
} uEdges;

/// Surfaces whose motion differs by less, and the diameters of whose circles of confusion by less than the
/// other, count as one: the mean of their colours moves with both. A smaller difference of diameters needs
/// more searches and gains nothing: `near` of the suite `lens` has 43.6 dB, with 0.25 px 42.9.
const float kApartPx = 0.25f;
const float kApartConfusionPx = 4.0f;

/// Diameter of the circle of confusion, pixels, negative before the focus plane.
float confusionAt(float depth) {
    return 2.0f * (params.confusion.x - params.confusion.y / max(depth, kMinDepth));
}

bool isSame(vec3 motionDepthA, vec3 motionDepthB) {
    return distance(motionDepthA.xy, motionDepthB.xy) < kApartPx &&
           abs(confusionAt(motionDepthA.z) - confusionAt(motionDepthB.z)) < kApartConfusionPx;
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

/// A sample and its surface.
struct Seen {
    int index;
    float depth;
    uint id;
};

/// Finds the entity that covers most of the samples; of two that cover as many, the nearer.
/// \param among a bit for each sample that counts, at least one
Seen findEntity(vec3 motionDepths[kSampleCount], uint ids[kSampleCount], uint among) {
    Seen found = Seen(0, 0.0f, 0u);
    uint most = 0u;
    for (uint i = 0u; i < kSampleCount; ++i) {
        if ((among >> i & 1u) == 0u) continue;
        uint count = 0u;
        for (uint j = 0u; j < kSampleCount; ++j)
            if ((among >> j & 1u) != 0u && ids[j] == ids[i]) ++count;
        bool isNearer = count == most && motionDepths[i].z < found.depth;
        if (count <= most && !isNearer) continue;
        most = count;
        found = Seen(int(i), motionDepths[i].z, ids[i]);
    }
    return found;
}

/// \param among a bit for each sample that counts, at least one
vec4 meanColor(vec4 colors[kSampleCount], uint among) {
    vec4 sum = vec4(0.0f);
    for (uint i = 0u; i < kSampleCount; ++i)
        if ((among >> i & 1u) != 0u) sum += colors[i];
    return sum / float(bitCount(among));
}

void main() {
    uint index = (gl_WorkGroupID.y * kSplitRow + gl_WorkGroupID.x) * kSplitGroupSize +
                 gl_LocalInvocationIndex;
    if (index >= uEdges.count) return;
    uint packed = uEdges.pixels[index];
    ivec2 pixel = ivec2(packed & 0xFFFFu, packed >> 16);
    const uint kAll = (1u << kSampleCount) - 1u;
    vec3 motionDepths[kSampleCount];
    vec4 colors[kSampleCount];
    uint ids[kSampleCount];
    for (uint i = 0u; i < kSampleCount; ++i) {
        uvec4 surface = texelFetch(uSurfaceSamples, pixel, int(i));
        ids[i] = rowOfSample(surface.w);
        motionDepths[i] = uintBitsToFloat(surface.xyz);
        colors[i] = texelFetch(uColorSamples, pixel, int(i));
    }
    uint own = findMost(motionDepths, kAll);
    uint others = params.keepsEdges != 0u ? kAll & ~own : 0u;
    if (others != 0u) {
        uint other = findMost(motionDepths, others);
        Seen seen = findEntity(motionDepths, ids, other);
        vec4 color = meanColor(colors, other);
        imageStore(
            uEdgeSurface, pixel,
            uvec4(
                floatBitsToUint(seen.depth), seen.id, packHalf2x16(color.rg),
                packHalf2x16(vec2(color.b, 0.0f))
            )
        );
    }
    Seen seen = findEntity(motionDepths, ids, own);
    imageStore(uColor, pixel, meanColor(colors, kAll & ~others));
    storeSurface(pixel, seen.index, texelFetch(uSurfaceSamples, pixel, seen.index), others);
}
