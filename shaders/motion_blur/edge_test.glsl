// SPDX-License-Identifier: MIT
// First two tests of the ray mask. A moving pixel is a candidate if its place one motion away
// belongs to another mesh and lies deeper, and, with kFlagRelativeMask, moves differently; a
// candidate is an edge if the 5x5 Sobel filter detects one. Before it: `params`, `method`
// (HybridParams), and textures uMotionDepth, uNormal and uEntityId.
#ifndef SHUTTER_MOTION_BLUR_EDGE_TEST_GLSL
#define SHUTTER_MOTION_BLUR_EDGE_TEST_GLSL

#include "motion_blur/ray_mask.glsl"
#include "motion_blur/weights.glsl"

vec2 uvAt(vec2 positionPx) { return positionPx / vec2(params.sizePx); }

/// \param target motion, no longer than a tile, and depth
bool revealsAt(vec2 centre, vec2 offset, vec3 target, uint entityId) {
    if (length(offset) < kStillPx) return false;
    // Beyond the picture the last pixel in it is the best guess.
    vec2 next = clamp(centre + offset, vec2(0.5f), vec2(params.sizePx) - 0.5f);
    if (textureLod(uEntityId, uvAt(next), 0.0f).x == entityId) return false;
    vec3 behind = textureLod(uMotionDepth, uvAt(next), 0.0f).xyz;
    if (!(behind.z - target.z >
          softExtent(target.z, params.softDepthExtent, params.softDepthShare)))
        return false;
    if ((method.flags & kFlagRelativeMask) == 0u) return true;
    vec2 motion = limitMotion(behind, float(params.tileSizePx), params.maxMotionDepth);
    return length(motion - target.xy) >= kStillPx;
}

bool isCandidate(vec2 centre) {
    vec3 target = textureLod(uMotionDepth, uvAt(centre), 0.0f).xyz;
    vec2 motion = limitMotion(target, float(params.tileSizePx), params.maxMotionDepth);
    if (length(motion) < kStillPx) return false;
    uint entityId = textureLod(uEntityId, uvAt(centre), 0.0f).x;
    vec3 moving = vec3(motion, target.z);
    return revealsAt(centre, motion * params.rasterTime, moving, entityId) ||
           revealsAt(centre, motion * (params.rasterTime - 1.0f), moving, entityId);
}

/// Normal and depth; clamped to the border by the sampler.
vec4 surfaceAt(vec2 positionPx) {
    vec2 uv = uvAt(positionPx);
    return vec4(
        textureLod(uNormal, uv, 0.0f).xyz, textureLod(uMotionDepth, uv, 0.0f).z
    );
}

float measureEdge(vec2 centre) {
    // The kernel is separable: each row's smoothed and derived value, weighed by the column's.
    vec4 gradientX = vec4(0.0f);
    vec4 gradientY = vec4(0.0f);
    for (int y = -2; y <= 2; ++y) {
        vec4 smoothed = vec4(0.0f);
        vec4 derived = vec4(0.0f);
        for (int x = -2; x <= 2; ++x) {
            vec4 surface = surfaceAt(centre + vec2(x, y));
            smoothed += sobelSmooth(x) * surface;
            derived += sobelDerive(x) * surface;
        }
        gradientX += sobelSmooth(y) * derived;
        gradientY += sobelDerive(y) * smoothed;
    }
    return edgeMeasure(vec2(gradientX.w, gradientY.w), gradientX.xyz, gradientY.xyz);
}

#endif
