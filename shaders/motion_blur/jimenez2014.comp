// SPDX-License-Identifier: MIT
// Jimenez 2014: pairs of taps around the middle of the exposure, weights mirrored; the uncovered
// share has the pixel's own colour.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "motion_blur/motion_blur_shared.h"
#include "motion_blur/jimenez2014.glsl"

#define SHUTTER_BLOCK_LIST_BINDING 4
#include "motion_blur/block_list.glsl"

layout(local_size_x = kGroupSize, local_size_y = kGroupSize) in;
layout(push_constant, scalar) uniform Push { MotionBlurParams params; };
layout(binding = 0) uniform sampler2D uColor;
layout(binding = 1) uniform sampler2D uMotionDepth;
layout(binding = 2) uniform sampler2D uDominant;
layout(binding = 3, rgba16f) uniform writeonly image2D uBlurred;

struct Tap {
    vec3 color;
    float weight;
    float depth;
    float speed;
};

/// \param target motion, no longer than a tile, and depth
/// \param soft SOFT_Z_EXTENT at the target
Tap takeTap(vec2 centre, vec2 offset, vec3 target, float soft, float pixelsToTaps) {
    vec2 uv = (centre + offset) / vec2(params.sizePx);
    vec4 motionDepth = textureLod(uMotionDepth, uv, 0.0f);
    vec2 motion = limitMotion(motionDepth.xyz, float(params.tileSizePx), params.maxMotionDepth);
    Tap tap;
    tap.color = textureLod(uColor, uv, 0.0f).rgb;
    tap.depth = motionDepth.z;
    tap.speed = length(motion);
    tap.weight = jimenezWeight(
        (target.z - tap.depth) / soft, length(offset) * pixelsToTaps,
        smearReach(offset, motion, params.rasterTime) * pixelsToTaps,
        smearReach(offset, target.xy, params.rasterTime) * pixelsToTaps
    );
    return tap;
}

vec3 gather(vec2 dominant, vec3 target, vec2 centre) {
    uint pairs = (params.sampleCount + 1u) >> 1u;
    uint count = 2u * pairs;
    float pixelsToTaps = float(count) / length(dominant);
    float offset = mix(0.5f, interleavedGradientNoise(floor(centre)), params.jitter);
    float soft = softExtent(target.z, params.softDepthExtent, params.softDepthShare);
    vec3 sum = vec3(0.0f);
    float weight = 0.0f;
    for (uint i = 0u; i < pairs; ++i) {
        // The farther of the two comes first: its weight is what a pair of equals gets, and in an
        // exposure that is not centred the nearer one's would pull in colours from afar.
        uint far = params.rasterTime >= 0.5f ? count - 1u - i : i;
        float farPosition = tapPosition(far, offset, count, params.rasterTime);
        float nearPosition = tapPosition(count - 1u - far, offset, count, params.rasterTime);
        farPosition = warpTapAt(params.response, farPosition, params.rasterTime);
        nearPosition = warpTapAt(params.response, nearPosition, params.rasterTime);
        Tap first = takeTap(centre, dominant * farPosition, target, soft, pixelsToTaps);
        Tap second = takeTap(centre, dominant * nearPosition, target, soft, pixelsToTaps);
        vec2 weights = mirrorWeights(
            vec2(first.weight, second.weight), vec2(first.depth, second.depth),
            vec2(first.speed, second.speed)
        );
        sum += first.color * weights.x + second.color * weights.y;
        weight += weights.x + weights.y;
    }
    vec3 sharp = textureLod(uColor, centre / vec2(params.sizePx), 0.0f).rgb;
    return (sum + (float(count) - weight) * sharp) / float(count);
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
    if (length(dominant) < kStillPx)
        imageStore(uBlurred, pixel, textureLod(uColor, uv, 0.0f));
    else
        imageStore(uBlurred, pixel, vec4(gather(dominant, vec3(motion, target.z), centre), 1.0f));
}
