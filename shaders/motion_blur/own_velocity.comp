// SPDX-License-Identifier: MIT
// The mean of samples along the pixel's own motion, as three.js and Babylon.js take it; with the
// occluder test as Bevy does.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "motion_blur/own_velocity_shared.h"
#include "motion_blur/motion_blur_shared.h"
#include "motion_blur/own_velocity.glsl"

#define SHUTTER_BLOCK_LIST_BINDING 3
#include "motion_blur/block_list.glsl"

layout(local_size_x = kGroupSize, local_size_y = kGroupSize) in;
layout(push_constant, scalar) uniform Push {
    MotionBlurParams params;
    OwnVelocityParams method;
};
layout(binding = 0) uniform sampler2D uColor;
layout(binding = 1) uniform sampler2D uMotionDepth;
layout(binding = 2, rgba16f) uniform writeonly image2D uBlurred;

/// Whether the tap may count (Bevy's test): nothing outside the picture, and nothing that is not
/// behind the pixel and could not have been over it.
bool passesOccluderTest(vec2 at, vec2 offset, float depth) {
    if (any(lessThan(at, vec2(0.0f))) || any(greaterThan(at, vec2(params.sizePx)))) return false;
    vec4 tap = textureLod(uMotionDepth, at / vec2(params.sizePx), 0.0f);
    return tap.z > depth ||
           couldCover(offset, limitMotion(tap.xyz, kLongestOwnMotionPx, params.maxMotionDepth), params.rasterTime);
}

void main() {
    ivec2 pixel;
    if (!findPixel(params.sizePx, pixel)) return;
    vec2 centre = vec2(pixel) + 0.5f;
    vec2 pixelsToUv = 1.0f / vec2(params.sizePx);
    vec4 target = textureLod(uMotionDepth, centre * pixelsToUv, 0.0f);
    vec2 motion = limitMotion(target.xyz, kLongestOwnMotionPx, params.maxMotionDepth);
    vec4 sharp = textureLod(uColor, centre * pixelsToUv, 0.0f);
    vec3 sum = vec3(0.0f);
    float weight = 0.0f;
    if (length(motion) >= kStillPx) {
        float offset = mix(0.5f, interleavedGradientNoise(floor(centre)), params.jitter);
        for (uint i = 0u; i < params.sampleCount; ++i) {
            float u = tapPosition(i, offset, params.sampleCount, params.rasterTime);
            vec2 along = motion * warpTapAt(params.response, u, params.rasterTime);
            vec2 at = centre + along;
            if (method.dropsOccluders != 0u &&
                !passesOccluderTest(at, along, target.z))
                continue;
            sum += textureLod(uColor, at * pixelsToUv, 0.0f).rgb;
            weight += 1.0f;
        }
    }
    // Still, or every tap refused: the sharp colour, bit for bit.
    imageStore(uBlurred, pixel, weight > 0.0f ? vec4(sum / weight, 1.0f) : sharp);
}
