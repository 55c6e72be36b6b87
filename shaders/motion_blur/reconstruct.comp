// SPDX-License-Identifier: MIT
// Gather of one layer (the raster's) and, inside the ray mask, of the revealed one; then the
// composite by weight.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "motion_blur/motion_blur_shared.h"
#include "motion_blur/taps.glsl"

layout(constant_id = 0) const uint kHybrid = 0u; // 1: the revealed layer and the mask are bound

layout(local_size_x = kGroupSize, local_size_y = kGroupSize) in;
layout(push_constant, scalar) uniform Push { MotionBlurParams params; };
layout(binding = 0) uniform sampler2D uColor;
layout(binding = 1) uniform sampler2D uMotionDepth;
layout(binding = 2) uniform sampler2D uDominant;
layout(binding = 3) uniform sampler2D uRevealColor;
layout(binding = 4) uniform sampler2D uRevealMotionDepth;
layout(binding = 5) uniform sampler2D uRevealDominant;
layout(binding = 6) uniform sampler2D uMask;
layout(binding = 7, rgba16f) uniform writeonly image2D uBlurred;

struct Gathered {
    vec3 sum;
    float weight;
};

Gathered gather(sampler2D color, sampler2D motionDepth, vec2 dominant, vec2 centre) {
    vec2 pixelsToUv = 1.0f / vec2(params.sizePx);
    vec4 target = textureLod(motionDepth, centre * pixelsToUv, 0.0f);
    float targetSpeed = finiteSpeed(target.xy);
    Gathered result;
    result.weight = centreWeight(targetSpeed);
    result.sum = textureLod(color, centre * pixelsToUv, 0.0f).rgb * result.weight;
    float range = length(dominant);
    if (range < kStillPx) return result;

    float offset = mix(0.5f, interleavedGradientNoise(floor(centre)), params.jitter);
    for (uint i = 0u; i < params.sampleCount; ++i) {
        float u = warpTapAt(
            params.response, tapPosition(i, offset, params.sampleCount, params.rasterShare),
            params.rasterShare
        );
        // A smear reaches this share of its length to this side of the raster instant.
        float reach = u >= 0.0f ? params.rasterShare : 1.0f - params.rasterShare;
        vec2 uv = (centre + dominant * u) * pixelsToUv;
        vec4 tap = textureLod(motionDepth, uv, 0.0f);
        float z = (target.z - tap.z) / params.softDepthExtent;
        float weight = sampleWeight(
            z, range * abs(u), finiteSpeed(tap.xy) * reach, targetSpeed * reach,
            params.foregroundMagnification
        );
        result.sum += textureLod(color, uv, 0.0f).rgb * weight;
        result.weight += weight;
    }
    return result;
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(uvec2(pixel), params.sizePx))) return;
    vec2 centre = vec2(pixel) + 0.5f;
    vec2 tile = tileUv(centre, params.tileSizePx, params.tileCount);
    vec2 dominant = textureLod(uDominant, tile, 0.0f).xy;
    vec2 uv = centre / vec2(params.sizePx);
    // Nothing moves within reach: the sharp colour, bit for bit.
    if (length(dominant) < kStillPx) {
        imageStore(uBlurred, pixel, textureLod(uColor, uv, 0.0f));
        return;
    }
    Gathered front = gather(uColor, uMotionDepth, dominant, centre);
    vec3 sum = front.sum;
    float weight = front.weight;
    if (kHybrid != 0u && textureLod(uMask, uv, 0.0f).x > 0.5f) {
        vec2 revealDominant = textureLod(uRevealDominant, tile, 0.0f).xy;
        Gathered back = gather(uRevealColor, uRevealMotionDepth, revealDominant, centre);
        float magnify = params.backgroundMagnification;
        sum = front.sum / magnify + back.sum * magnify;
        weight = front.weight / magnify + back.weight * magnify;
    }
    imageStore(uBlurred, pixel, vec4(sum / weight, 1.0f));
}
