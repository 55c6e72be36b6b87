// SPDX-License-Identifier: MIT
// The scene as rays see it that each have their own time of the exposure: right on average, noisy
// in each pixel (Cook 1984). Motion and depth are those of the surface that moves most in the pixel.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/sampling.glsl"
#include "common/shutter_response.glsl"
#include "motion_blur/denoise.glsl"
#include "motion_blur/denoised_shared.h"
#include "motion_blur/motion_blur_shared.h"
#include "motion_blur/weights.glsl"
#include "render/distributed_ray.glsl"
#include "render/point_motion.glsl"
#include "render/sky.glsl"
#include "render/view_ray.glsl"

layout(local_size_x = kGroupSize, local_size_y = kGroupSize) in;
layout(push_constant, scalar) uniform Push {
    MotionBlurParams params;
    DenoisedParams method;
};
layout(set = 0, binding = 0) uniform accelerationStructureEXT uScene;
layout(set = 0, binding = 1, rgba16f) uniform writeonly image2D uNoisy;
layout(set = 0, binding = 2, rgba32f) uniform writeonly image2D uMotionDepth;

vec2 motionOf(FrameRef frame, DistributedSample seen, vec2 centre) {
    if (seen.id.entity == kNoEntity)
        return skyMotion(frame, centre, makeViewRay(frame, centre).direction);
    return motionOfPoint(frame, seen.id, seen.objectPosition);
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(uvec2(pixel), params.sizePx))) return;
    FrameRef frame = FrameRef(method.frame);
    TimedRef moving = TimedRef(method.timed);
    vec2 centre = vec2(pixel) + 0.5f;
    float offset = interleavedGradientNoise(vec2(pixel));
    uint seed = hashPixel(uvec2(pixel), 0u, 0u);
    vec3 sum = vec3(0.0f);
    float sum1 = 0.0f;
    float sum2 = 0.0f;
    vec4 motionDepth = vec4(0.0f, 0.0f, kSkyDepth, 0.0f);
    for (uint i = 0u; i < params.sampleCount; ++i) {
        float s = respondAt(params.response, (float(i) + offset) / float(params.sampleCount));
        ShutterRay ray = makeLensRay(frame, moving, centre, i, seed, s);
        DistributedSample seen = traceDistributed(uScene, frame, moving, ray, s);
        vec3 color = storableColor(seen.radiance);
        float light = luminance(color);
        sum += color;
        sum1 += light;
        sum2 += light * light;
        vec2 motion = motionOf(frame, seen, centre);
        bool isLonger = dot(motion, motion) > dot(motionDepth.xy, motionDepth.xy);
        if (i == 0u || isLonger) motionDepth = vec4(motion, seen.depth, 0.0f);
    }
    imageStore(
        uNoisy, pixel,
        vec4(sum / float(params.sampleCount), deviationOfMean(sum1, sum2, params.sampleCount))
    );
    imageStore(uMotionDepth, pixel, motionDepth);
}
