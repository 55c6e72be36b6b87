// SPDX-License-Identifier: MIT
// McGuire, Hennessy, Bukowski, Osman: "A Reconstruction Filter for Plausible Motion Blur", I3D 2012.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "motion_blur/motion_blur_shared.h"
#include "motion_blur/taps.glsl"

#define SHUTTER_BLOCK_LIST_BINDING 4
#include "motion_blur/block_list.glsl"

layout(local_size_x = kGroupSize, local_size_y = kGroupSize) in;
layout(push_constant, scalar) uniform Push { MotionBlurParams params; };
layout(binding = 0) uniform sampler2D uColor;
layout(binding = 1) uniform sampler2D uMotionDepth;
layout(binding = 2) uniform sampler2D uDominant;
layout(binding = 3, rgba16f) uniform writeonly image2D uBlurred;

vec3 gather(vec2 dominant, vec2 centre) {
    vec2 pixelsToUv = 1.0f / vec2(params.sizePx);
    float limit = float(params.tileSizePx);
    vec4 target = textureLod(uMotionDepth, centre * pixelsToUv, 0.0f);
    vec2 targetMotion = limitMotion(target.xyz, limit, params.maxMotionDepth);
    float weight = centreWeight(0.5f * length(targetMotion)); // 1 / |V|, V a half velocity
    vec3 sum = textureLod(uColor, centre * pixelsToUv, 0.0f).rgb * weight;
    float jitter = (interleavedGradientNoise(floor(centre)) - 0.5f) * params.jitter;
    float soft = softExtent(target.z, params.softDepthExtent, params.softDepthShare);
    float halfTap = 0.5f / float(params.sampleCount + 1u);
    float centreTap = findCentreTapAt(params.response, params.rasterTime);
    for (uint i = 0u; i < params.sampleCount; ++i) {
        // The tap that is the target itself (the middle one of a centred exposure) is counted above.
        float even = innerTapPosition(i, 0.0f, params.sampleCount, params.rasterTime);
        if (abs(even - centreTap) < halfTap) continue;
        float u = innerTapPosition(i, jitter, params.sampleCount, params.rasterTime);
        vec2 offset = dominant * warpTapAt(params.response, u, params.rasterTime);
        vec2 uv = (centre + offset) * pixelsToUv;
        vec4 tap = textureLod(uMotionDepth, uv, 0.0f);
        float tapWeight = sampleWeight(
            (target.z - tap.z) / soft, length(offset),
            smearReach(offset, limitMotion(tap.xyz, limit, params.maxMotionDepth), params.rasterTime),
            smearReach(offset, targetMotion, params.rasterTime), 1.0f
        );
        sum += textureLod(uColor, uv, 0.0f).rgb * tapWeight;
        weight += tapWeight;
    }
    return sum / weight;
}

void main() {
    ivec2 pixel;
    if (!findPixel(params.sizePx, pixel)) return;
    vec2 centre = vec2(pixel) + 0.5f;
    vec2 dominant =
        textureLod(uDominant, tileUv(centre, params.tileSizePx, params.tileCount), 0.0f).xy;
    // Nothing moves within reach: the sharp colour, bit for bit.
    if (length(dominant) < kStillPx)
        imageStore(uBlurred, pixel, textureLod(uColor, centre / vec2(params.sizePx), 0.0f));
    else
        imageStore(uBlurred, pixel, vec4(gather(dominant, centre), 1.0f));
}
