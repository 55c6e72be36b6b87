// SPDX-License-Identifier: MIT
// Traces the samples whose guess may do the most harm, each at its own time through the moving scene,
// as far as the frame's rays go; looks the others of the pixel up again.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "common/sampling.glsl"
#include "motion_blur/motion_blur_shared.h"
#include "motion_blur/resolved_shared.h"
#include "render/distributed_ray.glsl"

const bool kFindsEdges = true;

layout(local_size_x = kRevealThreads) in;
layout(push_constant, scalar) uniform Push {
    MotionBlurParams params;
    ResolvedParams method;
};

#include "motion_blur/resolved_search.glsl"

layout(binding = 16, scalar) readonly buffer ListedPixels { uvec2 uListed[]; };
layout(binding = 17) uniform accelerationStructureEXT uScene;

/// Share of the samples of each class that the frame's rays are enough for, the most harmful first.
void shareRays(out float shares[kSampleClasses]) {
    float left = method.rayLimit == kNoRayLimit ? kFarthest : float(method.rayLimit);
    for (uint i = 0u; i < kSampleClasses; ++i) {
        float wanted = float(uCounters.classes[i]);
        shares[i] = wanted > 0.0f ? saturate(left / wanted) : 0.0f;
        left = max(left - wanted, 0.0f);
    }
}

/// The same samples in every frame of the same numbers, spread over the picture.
bool isTraced(ivec2 pixel, uint index, float share) {
    return share >= 1.0f || unitFloat(hashPixel(uvec2(pixel), index, 0u)) < share;
}

/// In the tables.
uint instantOf(PixelSearch search, uint index) { return index * method.setCount + search.set; }

/// What is known of a pixel's samples.
struct Mean {
    vec3 sum;
    uint known;
};

/// Adds those of 32 samples that are not traced. \return those that are, a bit each
uint addGuesses(
    PixelSearch search, ivec2 pixel, uint first, float shares[kSampleClasses], inout Guesses guesses,
    inout Mean mean
) {
    uint traced = 0u;
    for (uint i = 0u; i < min(params.sampleCount - first, 32u); ++i) {
        Doubt doubt = kNoDoubt;
        Seen seen = searchInstant(search, instantOf(search, first + i), guesses, doubt);
        vec3 color = vec3(0.0f);
        if (seen.isFound)
            color = colorOf(seen);
        else if (doubt.hasBeside)
            color = fetchColor(kRasterLayer, doubt.beside);
        if (isTraced(pixel, first + i, shares[classify(seen, color, doubt)])) {
            traced |= 1u << i;
        } else if (seen.isFound || doubt.hasBeside) {
            mean.sum += color;
            ++mean.known;
        }
    }
    return traced;
}

void main() {
    uint index = (gl_WorkGroupID.y * kListRow + gl_WorkGroupID.x) * kRevealThreads +
                 gl_LocalInvocationIndex;
    if (index >= uCounters.listedPixels) return;
    float shares[kSampleClasses];
    shareRays(shares);
    uvec2 entry = uListed[index];
    bool hasRays = false;
    for (uint i = 0u; i < kSampleClasses; ++i)
        hasRays = hasRays || ((entry.y >> i & 1u) != 0u && shares[i] > 0.0f);
    if (!hasRays) return;
    ivec2 pixel = ivec2(entry.x & 0xFFFFu, entry.x >> 16);
    PixelSearch search = beginSearch(pixel);
    Guesses guesses = beginGuesses(search);
    InstantMotionsRef motions = InstantMotionsRef(method.motions);
    Mean mean = Mean(vec3(0.0f), 0u);
    uint rays = 0u;
    for (uint first = 0u; first < params.sampleCount; first += 32u) {
        // Which samples first, then the rays: threads side by side trace at the same time, although
        // not the same instants.
        uint traced = addGuesses(search, pixel, first, shares, guesses, mean);
        for (; traced != 0u; traced &= traced - 1u) {
            DistributedSample ray = traceDistributed(
                uScene, FrameRef(method.frame), TimedRef(method.timed), search.x,
                timeOf(motions, instantOf(search, first + uint(findLSB(traced))))
            );
            mean.sum += storableColor(ray.radiance);
            ++mean.known;
            ++rays;
        }
    }
    if (rays == 0u) return;
    atomicAdd(uCounters.rays, rays);
    imageStore(uBlurred, pixel, vec4(mean.sum / float(mean.known), 1.0f));
}
