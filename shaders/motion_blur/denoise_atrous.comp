// SPDX-License-Identifier: MIT
// One level of the a-trous filter along the dominant motion.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "motion_blur/denoise.glsl"
#include "motion_blur/denoised_shared.h"
#include "motion_blur/motion_blur_shared.h"
#include "motion_blur/weights.glsl"

layout(local_size_x = kGroupSize, local_size_y = kGroupSize) in;
layout(push_constant, scalar) uniform Push {
    MotionBlurParams params;
    DenoisedParams method;
};
layout(binding = 0) uniform sampler2D uColorDeviation;
layout(binding = 1) uniform sampler2D uDominant;
layout(binding = 2, rgba16f) uniform writeonly image2D uFiltered;

vec4 filterAlong(vec2 centre, vec4 own, vec2 step_) {
    vec2 size = vec2(params.sizePx);
    float ownLight = luminance(own.rgb);
    vec3 sum = vec3(0.0f);
    float variance = 0.0f;
    float weights = 0.0f;
    for (int k = -2; k <= 2; ++k) {
        vec2 at = centre + float(k) * step_;
        // Beyond the picture's border nothing is known; a clamped tap would count twice.
        if (any(lessThan(at, vec2(0.0f))) || any(greaterThanEqual(at, size))) continue;
        vec4 tap = textureLod(uColorDeviation, at / size, 0.0f);
        float weight =
            atrousWeight(k) *
            luminanceWeight(luminance(tap.rgb) - ownLight, own.a, method.luminanceSigma);
        sum += weight * tap.rgb;
        variance += weight * weight * tap.a * tap.a;
        weights += weight;
    }
    return vec4(sum / weights, sqrt(variance) / weights);
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(uvec2(pixel), params.sizePx))) return;
    vec2 centre = vec2(pixel) + 0.5f;
    vec4 result = textureLod(uColorDeviation, centre / vec2(params.sizePx), 0.0f);
    vec2 tile = tileUv(centre, params.tileSizePx, params.tileCount);
    vec2 dominant = textureLod(uDominant, tile, 0.0f).xy;
    float range = length(dominant);
    if (range >= kStillPx && levelFits(method.stepPx, range))
        result = filterAlong(centre, result, dominant / range * method.stepPx);
    imageStore(uFiltered, pixel, result);
}
