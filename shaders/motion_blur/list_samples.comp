// SPDX-License-Identifier: MIT
// Lists the samples whose guess may do the most harm, for a host that answers them by its own means.
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
layout(binding = 24, scalar) buffer RequestedSamples {
    SampleHeader uHeader;
    RequestedSample uRequested[];
};
layout(binding = 25, scalar) writeonly buffer Answers { vec4 uAnswers[]; };
/// Where each listed pixel's samples begin in the list; kNoSamples: it requests none.
layout(binding = 26, scalar) writeonly buffer FirstSamples { uint uFirst[]; };
layout(binding = 27, scalar) buffer Groups { DispatchArguments uGroups; };
/// By sample, with a lens: its place there, metres right and up in the picture.
layout(binding = 28, scalar) writeonly buffer LensPlaces { vec2 uPlaces[]; };

const uint kMaxChunks = 8u; // of 32 samples

/// Takes room for `count` samples. \return where they begin, which may lie past the list's end
uint takeRoom(uint count) {
    uint first = atomicAdd(uHeader.wanted, count);
    uint end = min(first + count, uHeader.capacity);
    if (first >= end) return first;
    atomicMax(uHeader.listed, end);
    uint groups = (end + kRevealThreads - 1u) / kRevealThreads;
    atomicMax(uGroups.groupsX, min(groups, kListRow));
    atomicMax(uGroups.groupsY, (groups + kListRow - 1u) / kListRow);
    return first;
}

void main() {
    uint index = (gl_WorkGroupID.y * kListRow + gl_WorkGroupID.x) * kRevealThreads +
                 gl_LocalInvocationIndex;
    if (index >= uCounters.listedPixels) return;
    uFirst[index] = kNoSamples;
    float shares[kSampleClasses];
    shareRays(shares);
    uvec2 entry = uListed[index];
    if (!mayTrace(entry.y, shares)) return;
    ivec2 pixel = ivec2(entry.x & 0xFFFFu, entry.x >> 16);
    PixelSearch search = beginSearch(pixel);
    Guesses guesses = beginGuesses(search);
    Mean ignored = Mean(vec3(0.0f), 0u, kFarthest);
    uint traced[kMaxChunks];
    uint count = 0u;
    for (uint chunk = 0u; chunk * 32u < params.sampleCount; ++chunk) {
        traced[chunk] = addGuesses(search, pixel, chunk * 32u, shares, guesses, ignored);
        count += bitCount(traced[chunk]);
    }
    if (count == 0u) return;
    uint slot = takeRoom(count);
    if (slot >= uHeader.capacity) return;
    uFirst[index] = slot;
    InstantMotionsRef motions = InstantMotionsRef(method.motions);
    for (uint chunk = 0u; chunk * 32u < params.sampleCount; ++chunk)
        for (uint left = traced[chunk]; left != 0u && slot < uHeader.capacity; left &= left - 1u) {
            uint taken = chunk * 32u + uint(findLSB(left));
            uint instant = instantOf(search, taken);
            uRequested[slot] = RequestedSample(entry.x, timeOf(motions, instant));
            if (kHasLens) uPlaces[slot] = LensPlaceTable(motions.value.lensPlaces).places[instant];
            uAnswers[slot] = vec4(0.0f);
            ++slot;
        }
}
