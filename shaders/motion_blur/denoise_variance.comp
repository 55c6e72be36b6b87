// SPDX-License-Identifier: MIT
// Standard deviation of the luminance about each pixel into alpha: its rays' own where they are
// enough, else its neighbours' along the motion.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "motion_blur/denoise.glsl"
#include "motion_blur/motion_blur_shared.h"
#include "motion_blur/weights.glsl"

layout(local_size_x = kGroupSize, local_size_y = kGroupSize) in;
layout(push_constant, scalar) uniform Push { MotionBlurParams params; };
layout(binding = 0) uniform sampler2D uNoisy;
layout(binding = 1) uniform sampler2D uMotionDepth;
layout(binding = 2) uniform sampler2D uDominant;
layout(binding = 3, rgba16f) uniform writeonly image2D uColorDeviation;

/// Taps along the motion that detect surfaces passing the pixel.
const int kPassersBy = 8; // to each side

/// True where the pixel moves or something near it passes it. Elsewhere all its rays have the same
/// result, and differences to its neighbours are texture, not noise.
bool isPassed(vec2 centre, vec2 dominant) {
    vec2 pixelsToUv = 1.0f / vec2(params.sizePx);
    for (int i = -kPassersBy; i <= kPassersBy; ++i) {
        vec2 offset = dominant * (float(i) / float(kPassersBy));
        float speed = length(textureLod(uMotionDepth, (centre + offset) * pixelsToUv, 0.0f).xy);
        if (speed >= kStillPx && speed >= length(offset)) return true;
    }
    return false;
}

float deviationOfNeighbours(vec2 centre, vec2 along) {
    vec2 pixelsToUv = 1.0f / vec2(params.sizePx);
    vec2 across = vec2(-along.y, along.x);
    float sum1 = 0.0f;
    float sum2 = 0.0f;
    for (int v = -1; v <= 1; ++v)
        for (int u = -3; u <= 3; ++u) {
            vec2 at = centre + float(u) * along + float(v) * across;
            float light = luminance(textureLod(uNoisy, at * pixelsToUv, 0.0f).rgb);
            sum1 += light;
            sum2 += light * light;
        }
    return sqrt(max(sum2 / 21.0f - sum1 * sum1 / 441.0f, 0.0f));
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(uvec2(pixel), params.sizePx))) return;
    vec2 centre = vec2(pixel) + 0.5f;
    vec4 noisy = textureLod(uNoisy, centre / vec2(params.sizePx), 0.0f);
    vec2 tile = tileUv(centre, params.tileSizePx, params.tileCount);
    vec2 dominant = textureLod(uDominant, tile, 0.0f).xy;
    float range = length(dominant);
    bool askNeighbours = range >= kStillPx && params.sampleCount < kRaysThatKnowVariance;
    if (askNeighbours && isPassed(centre, dominant))
        noisy.a = min(deviationOfNeighbours(centre, dominant / range), kMaxColor);
    imageStore(uColorDeviation, pixel, noisy);
}
