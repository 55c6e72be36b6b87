// SPDX-License-Identifier: MIT
// One batch of rays per pixel, added to the sums of earlier batches; mean and error of all so far.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/sampling.glsl"
#include "common/shutter_response.glsl"
#include "render/distributed_ray.glsl"
#include "truth/estimate.glsl"
#include "truth/truth_shared.h"

layout(local_size_x = kTruthGroupSize, local_size_y = kTruthGroupSize) in;
layout(push_constant, scalar) uniform Push { TruthParams params; };
layout(set = 0, binding = 0) uniform accelerationStructureEXT uScene;
layout(set = 0, binding = 1, rgba32f) uniform image2D uSumA;
layout(set = 0, binding = 2, rgba32f) uniform image2D uSumB;
layout(set = 0, binding = 3, rgba32f) uniform writeonly image2D uMean;
layout(set = 0, binding = 4, rgba32f) uniform writeonly image2D uError;
layout(set = 0, binding = 5, scalar) writeonly buffer Groups { vec2 uGroups[]; };

// Squared error and rays of each thread.
shared vec2 sTotals[kTruthGroupSize * kTruthGroupSize];

vec2 tracePixel(ivec2 pixel) {
    FrameRef frame = FrameRef(params.frame);
    TimedRef moving = TimedRef(params.moving);
    vec3 sumA = vec3(0.0f);
    vec3 sumB = vec3(0.0f);
    if (params.firstRay > 0u) {
        sumA = imageLoad(uSumA, pixel).rgb;
        sumB = imageLoad(uSumB, pixel).rgb;
    }
    uint rays = 0u;
    for (uint i = params.firstRay; i < params.firstRay + params.rayCount; ++i) {
        uint set_ = setOfRay(i);
        uint seed = hashPixel(uvec2(pixel), params.seed, set_);
        vec2 place = params.boxFilter != 0u ? pixelPlace(i >> 1u, seed) : vec2(0.5f);
        float s = respondAt(params.response, shutterTime(i >> 1u, seed));
        ShutterRay ray = makeLensRay(
            frame, moving, vec2(pixel) + place, i >> 1u, seed, s
        );
        DistributedSample sample_ = traceDistributed(uScene, frame, moving, ray, s);
        sumA += set_ == 0u ? sample_.radiance : vec3(0.0f);
        sumB += set_ == 0u ? vec3(0.0f) : sample_.radiance;
        rays += sample_.rays;
    }
    uint count = params.firstRay + params.rayCount;
    vec3 error = errorOfSets(sumA, sumB, count);
    imageStore(uSumA, pixel, vec4(sumA, 1.0f));
    imageStore(uSumB, pixel, vec4(sumB, 1.0f));
    imageStore(uMean, pixel, vec4(meanOfSets(sumA, sumB, count), 1.0f));
    imageStore(uError, pixel, vec4(error, 1.0f));
    return vec2(dot(error, error) * (1.0f / 3.0f), float(rays));
}

void main() {
    uvec2 pixel = gl_GlobalInvocationID.xy;
    vec2 totals = vec2(0.0f);
    if (all(lessThan(pixel, params.sizePx))) totals = tracePixel(ivec2(pixel));
    sTotals[gl_LocalInvocationIndex] = totals;
    barrier();
    if (gl_LocalInvocationIndex != 0u) return;
    vec2 sum = vec2(0.0f);
    for (uint i = 0u; i < kTruthGroupSize * kTruthGroupSize; ++i) sum += sTotals[i];
    uGroups[gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x] = sum;
}
