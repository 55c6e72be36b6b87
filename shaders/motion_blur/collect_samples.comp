// SPDX-License-Identifier: MIT
// Replaces requested samples by a host's answers. A sample without an answer retains its looked-up
// colour, and so does a pixel without any.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "motion_blur/motion_blur_shared.h"
#include "motion_blur/host_samples_shared.h"
#include "motion_blur/resolved_shared.h"

const bool kFindsEdges = true;

layout(local_size_x = kRevealThreads) in;
layout(push_constant, scalar) uniform Push {
    MotionBlurParams params;
    ResolvedParams method;
};

#include "motion_blur/resolved_rays.glsl"

layout(binding = 23, scalar) readonly buffer ListedPixels { uvec2 uListed[]; };
layout(binding = 24, scalar) readonly buffer RequestedSamples { SampleHeader uHeader; };
layout(binding = 25, scalar) readonly buffer Answers { vec4 uAnswers[]; };
layout(binding = 26, scalar) readonly buffer FirstSamples { uint uFirst[]; };

void main() {
    uint index = (gl_WorkGroupID.y * kListRow + gl_WorkGroupID.x) * kRevealThreads +
                 gl_LocalInvocationIndex;
    if (index >= uCounters.listedPixels) return;
    uint slot = uFirst[index];
    if (slot == kNoSamples) return;
    float shares[kSampleClasses];
    shareRays(shares);
    uint place = uListed[index].x;
    ivec2 pixel = ivec2(place & 0xFFFFu, place >> 16);
    PixelSearch search = beginSearch(pixel);
    Guesses guesses = beginGuesses(search);
    Mean mean = Mean(vec3(0.0f), 0u, kFarthest);
    uint firstSlot = slot;
    for (uint i = 0u; i < params.sampleCount; ++i) {
        LookedUp lookedUp = lookUpAgain(search, pixel, i, shares, guesses);
        bool isAnswered = false;
        if (lookedUp.isTraced) {
            isAnswered = slot < uHeader.capacity && uAnswers[slot].a > 0.0f;
            ++slot;
        }
        if (!isAnswered) addKnown(lookedUp, mean);
    }
    // Behind the others, as in the pass that traces: sums are the same to the bit.
    uint answered = 0u;
    for (uint i = firstSlot; i < min(slot, uHeader.capacity); ++i) {
        vec4 answer = uAnswers[i];
        if (!(answer.a > 0.0f)) continue;
        mean.sum += storableColor(answer.rgb);
        ++mean.known;
        if (kHasLens) // alpha is the depth of what the host found
            mean.confusionPx =
                min(mean.confusionPx, confusionAt(InstantMotionsRef(method.motions), answer.a));
        ++answered;
    }
    if (answered == 0u) return;
    atomicAdd(uCounters.rays, answered);
    imageStore(uBlurred, pixel, vec4(mean.sum / float(mean.known), alphaOf(search, mean)));
}
