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

#include "motion_blur/resolved_rays.glsl"

layout(binding = 23, scalar) readonly buffer ListedPixels { uvec2 uListed[]; };
layout(binding = 24) uniform accelerationStructureEXT uScene;

void main() {
    uint entryIndex = (gl_WorkGroupID.y * kListRow + gl_WorkGroupID.x) * kRevealThreads +
                      gl_LocalInvocationIndex;
    if (entryIndex >= uCounters.listedPixels) return;
    float shares[kSampleClasses];
    shareRays(shares);
    uvec2 entry = uListed[entryIndex];
    if (!mayTrace(entry.y, shares)) return;
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
            FrameRef frame = FrameRef(method.frame);
            TimedRef moving = TimedRef(method.timed);
            uint index = first + uint(findLSB(traced));
            float s = timeOf(motions, instantOf(search, index));
            ShutterRay ray = makeShutterRay(frame, moving, placeOfRay(search, index), s);
            DistributedSample seen = traceDistributed(uScene, frame, moving, ray, s);
            mean.sum += storableColor(seen.radiance);
            ++mean.known;
            ++rays;
        }
    }
    if (rays == 0u) return;
    atomicAdd(uCounters.rays, rays);
    imageStore(uBlurred, pixel, vec4(mean.sum / float(mean.known), 1.0f));
}
