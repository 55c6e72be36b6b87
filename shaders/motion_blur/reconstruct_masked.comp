// SPDX-License-Identifier: MIT
// Gather of the raster's layer and, inside the ray mask, of the revealed one; then the composite by
// weight. The revealed layer is what rays found in the mask and the raster elsewhere.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "motion_blur/gather_shared.h"
#include "motion_blur/motion_blur_shared.h"
#define SHUTTER_BLOCK_LIST_BINDING 8
#include "motion_blur/block_list.glsl"

layout(local_size_x = kGroupSize, local_size_y = kGroupSize) in;
layout(push_constant, scalar) uniform Push {
    MotionBlurParams params;
    GatherParams method;
};
layout(binding = 0) uniform sampler2D uColor;
layout(binding = 1) uniform sampler2D uMotionDepth;
layout(binding = 2) uniform sampler2D uDominant;
layout(binding = 3) uniform sampler2D uRevealColor;
layout(binding = 4) uniform sampler2D uRevealMotionDepth;
layout(binding = 5) uniform sampler2D uRevealDominant;
layout(binding = 6) uniform sampler2D uMask;
layout(binding = 7, rgba16f) uniform writeonly image2D uBlurred;

#include "motion_blur/gather_layer.glsl"

/// The gather of a masked pixel from the revealed layer.
Gathered gatherRevealed(vec2 dominant, vec2 centre) {
    vec2 pixelsToUv = 1.0f / vec2(params.sizePx);
    vec2 uv = centre * pixelsToUv;
    Target target = makeTarget(textureLod(uRevealMotionDepth, uv, 0.0f).xyz, centre);
    Gathered result;
    result.weight = centreWeight(target.speed);
    result.sum = textureLod(uRevealColor, uv, 0.0f).rgb * result.weight;
    float range = length(dominant);
    if (range < kStillPx) return result;
    for (uint i = 0u; i < countTaps(); ++i) {
        float u = placeTap(i, target);
        vec2 at = (centre + dominant * u) * pixelsToUv;
        vec3 motionDepth;
        vec3 color;
        if (textureLod(uMask, at, 0.0f).x > 0.5f) {
            motionDepth = textureLod(uRevealMotionDepth, at, 0.0f).xyz;
            color = textureLod(uRevealColor, at, 0.0f).rgb;
        } else {
            motionDepth = textureLod(uMotionDepth, at, 0.0f).xyz;
            color = textureLod(uColor, at, 0.0f).rgb;
        }
        float weight = weighTap(motionDepth, u, range, target);
        result.sum += color * weight;
        result.weight += weight;
    }
    return result;
}

void main() {
    ivec2 pixel;
    if (!findPixel(params.sizePx, pixel)) return;
    vec2 centre = vec2(pixel) + 0.5f;
    vec2 dominant = dominantAt(uDominant, centre);
    vec2 uv = centre / vec2(params.sizePx);
    // Nothing moves within reach: the sharp colour, bit for bit.
    if (length(dominant) < kStillPx) {
        imageStore(uBlurred, pixel, textureLod(uColor, uv, 0.0f));
        return;
    }
    Gathered front = gatherRaster(dominant, centre);
    vec3 sum = front.sum;
    float weight = front.weight;
    if (textureLod(uMask, uv, 0.0f).x > 0.5f) {
        Gathered back = gatherRevealed(dominantAt(uRevealDominant, centre), centre);
        float magnify = method.backgroundMagnification;
        sum = front.sum / magnify + back.sum * magnify;
        weight = front.weight / magnify + back.weight * magnify;
    }
    imageStore(uBlurred, pixel, vec4(sum / weight, 1.0f));
}
