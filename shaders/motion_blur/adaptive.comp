// SPDX-License-Identifier: MIT
// Traces the samples with the largest expected error, each at its time through the moving scene,
// within the frame's ray budget; repeats the pixel's other lookups.
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

/// On the ray's way by which it goes forward by 1.
vec3 stepOf(ShutterRay ray) { return ray.direction / dot(ray.direction, ray.forward); }

/// Through the instant's place of the lens: what that moves to `place` from where a pinhole has it.
ShutterRay makeSampleRay(FrameRef frame, TimedRef moving, vec2 place, uint instant, float s) {
    if (!kHasLens) return makeShutterRay(frame, moving, place, s);
    // At depth z the ray starts from place - xy - zw / z: a line that leaves the camera's plane off
    // its centre, scaled by the pixel spacing at depth 1.
    vec4 lens = lensOf(InstantMotionsRef(method.motions), instant);
    ShutterRay ray = makeShutterRay(frame, moving, place - lens.xy, s);
    const float kFarPx = 64.0f; // for digits
    vec3 step_ = stepOf(ray);
    vec3 perX = (stepOf(makeShutterRay(frame, moving, place - lens.xy + vec2(kFarPx, 0.0f), s)) - step_) / kFarPx;
    vec3 perY = (stepOf(makeShutterRay(frame, moving, place - lens.xy + vec2(0.0f, kFarPx), s)) - step_) / kFarPx;
    vec3 aside = -lens.z * perX - lens.w * perY;
    ray.eye += aside;
    ray.origin += aside;
    return ray;
}

/// The colour that a ray met.
/// \param place in the picture that the ray starts from
vec3 colorOfRay(DistributedSample seen, PixelSearch search, vec2 place, uint instant) {
    vec3 color = storableColor(seen.radiance);
    return kHasLens ? withoutPoint(color, keyOfId(seen.id.entity), seen.depth, search, place, instant) : color;
}

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
    Mean mean = Mean(vec3(0.0f), 0u, kFarthest);
    uint rays = 0u;
    for (uint first = 0u; first < params.sampleCount; first += 32u) {
        // Which samples first, then the rays: threads side by side trace at the same time, although
        // not the same instants.
        uint traced = addGuesses(search, pixel, first, shares, guesses, mean);
        for (; traced != 0u; traced &= traced - 1u) {
            FrameRef frame = FrameRef(method.frame);
            TimedRef moving = TimedRef(method.timed);
            uint index = first + uint(findLSB(traced));
            uint instant = instantOf(search, index);
            float s = timeOf(motions, instant);
            vec2 place = placeOfRay(search, index);
            ShutterRay ray = makeSampleRay(frame, moving, place, instant, s);
            DistributedSample seen = traceDistributed(uScene, frame, moving, ray, s);
            mean.sum += colorOfRay(seen, search, place, instant);
            ++mean.known;
            if (kHasLens)
                mean.confusionPx = min(mean.confusionPx, confusionAt(motions, seen.depth));
            ++rays;
        }
    }
    if (rays == 0u) return;
    atomicAdd(uCounters.rays, rays);
    imageStore(uBlurred, pixel, vec4(mean.sum / float(mean.known), alphaOf(search, mean)));
}
