// SPDX-License-Identifier: MIT
// Guertin et al. 2014: taps along the dominant motion and, where the motions around differ, along
// the pixel's own.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "motion_blur/guertin2014_shared.h"
#include "motion_blur/motion_blur_shared.h"
#include "motion_blur/guertin2014.glsl"

#define SHUTTER_BLOCK_LIST_BINDING 5
#include "motion_blur/block_list.glsl"

layout(local_size_x = kGroupSize, local_size_y = kGroupSize) in;
layout(push_constant, scalar) uniform Push {
    MotionBlurParams params;
    Guertin2014Params method;
};
layout(binding = 0) uniform sampler2D uColor;
layout(binding = 1) uniform sampler2D uMotionDepth;
layout(binding = 2) uniform sampler2D uDominant;
layout(binding = 3) uniform sampler2D uVariance;
layout(binding = 4, rgba16f) uniform writeonly image2D uBlurred;

/// \param target motion, no longer than a tile, and depth
vec3 gather(vec2 dominant, float variance, vec3 target, vec2 centre) {
    vec2 pixelsToUv = 1.0f / vec2(params.sizePx);
    float range = length(dominant);
    vec2 first = dominant / range;
    vec2 second = centreDirection(target.xy, first, method.speedThresholdPx);
    float speed = length(target.xy);
    float weight = guertinCentreWeight(speed, params.sampleCount, method.centreBias);
    vec3 sum = textureLod(uColor, centre * pixelsToUv, 0.0f).rgb * weight;
    float jitter = (2.0f * interleavedGradientNoise(floor(centre)) - 1.0f) * params.jitter *
                   guertinJitter(params.sampleCount);
    float soft = softExtent(target.z, params.softDepthExtent, params.softDepthShare);
    float side = 1.0f;
    for (uint i = 0u; i < params.sampleCount; ++i) {
        bool isSecond = isSecondDirection(i, variance);
        vec2 direction = isSecond ? second : first;
        // A static pixel's perpendicular has no sign: exposures that are not centred would sample
        // one side only.
        if (isSecond && speed < kStillPx) side = -side;
        float u = warpTapAt(
            params.response, innerTapPosition(i, jitter, params.sampleCount, params.rasterTime),
            params.rasterTime
        );
        vec2 offset = direction * (u * range * (isSecond ? side : 1.0f));
        vec2 uv = (centre + offset) * pixelsToUv;
        vec4 tap = textureLod(uMotionDepth, uv, 0.0f);
        vec2 tapMotion = limitMotion(tap.xyz, float(params.tileSizePx), params.maxMotionDepth);
        float tapWeight = guertinWeight(
            (target.z - tap.z) / soft, length(offset),
            smearReach(offset, tapMotion, params.rasterTime),
            smearReach(offset, target.xy, params.rasterTime), alignment(second, direction),
            alignment(tapMotion, direction)
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
    vec2 uv = centre / vec2(params.sizePx);
    vec2 tile = jitteredTileUv(
        centre, params.jitter, params.tileSizePx, params.tileCount, params.sizePx
    );
    vec4 target = textureLod(uMotionDepth, uv, 0.0f);
    vec2 motion = limitMotion(target.xyz, float(params.tileSizePx), params.maxMotionDepth);
    // Jitter may fetch a tile that is slower than the pixel.
    vec2 dominant = longerMotion(textureLod(uDominant, tile, 0.0f).xy, motion);
    // Nothing moves within reach: the sharp colour, bit for bit.
    if (length(dominant) < kStillPx) {
        imageStore(uBlurred, pixel, textureLod(uColor, uv, 0.0f));
        return;
    }
    float variance = textureLod(uVariance, tile, 0.0f).x;
    imageStore(
        uBlurred, pixel, vec4(gather(dominant, variance, vec3(motion, target.z), centre), 1.0f)
    );
}
