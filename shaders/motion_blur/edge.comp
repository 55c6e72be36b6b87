// SPDX-License-Identifier: MIT
// First two tests of the ray mask. A moving pixel is a candidate when its place one motion away
// belongs to another mesh and lies deeper; a candidate is an edge when the 5x5 Sobel says so.
// Writes r: candidate, g: edge measure x_n, b: edge.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "motion_blur/motion_blur_shared.h"
#include "motion_blur/ray_mask.glsl"
#include "motion_blur/weights.glsl"

layout(constant_id = 0) const uint kMeasureEverywhere = 0u; // debug view: x_n of every pixel

layout(local_size_x = kGroupSize, local_size_y = kGroupSize) in;
layout(push_constant, scalar) uniform Push { MotionBlurParams params; };
layout(binding = 0) uniform sampler2D uMotionDepth;
layout(binding = 1) uniform sampler2D uNormal;
layout(binding = 2) uniform usampler2D uMeshId;
layout(binding = 3) uniform sampler2D uDominant;
layout(binding = 4, rgba8) uniform writeonly image2D uEdge;

vec2 uvAt(vec2 positionPx) { return positionPx / vec2(params.sizePx); }

bool revealsAt(vec2 centre, vec2 offset, float depth, uint meshId) {
    if (length(offset) < kStillPx) return false;
    // Beyond the picture the last pixel in it is the best guess.
    vec2 next = clamp(centre + offset, vec2(0.5f), vec2(params.sizePx) - 0.5f);
    return textureLod(uMeshId, uvAt(next), 0.0f).x != meshId &&
           textureLod(uMotionDepth, uvAt(next), 0.0f).z - depth > params.softDepthExtent;
}

float measureEdge(vec2 centre) {
    vec2 depthGradient = vec2(0.0f);
    vec3 normalX = vec3(0.0f);
    vec3 normalY = vec3(0.0f);
    for (int y = -2; y <= 2; ++y)
        for (int x = -2; x <= 2; ++x) {
            vec2 uv = uvAt(centre + vec2(x, y)); // clamped to the border by the sampler
            float depth = textureLod(uMotionDepth, uv, 0.0f).z;
            vec3 normal = textureLod(uNormal, uv, 0.0f).xyz;
            vec2 kernel =
                vec2(sobelDerive(x) * sobelSmooth(y), sobelDerive(y) * sobelSmooth(x));
            depthGradient += kernel * depth;
            normalX += kernel.x * normal;
            normalY += kernel.y * normal;
        }
    return edgeMeasure(depthGradient, normalX, normalY);
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(uvec2(pixel), params.sizePx))) return;
    vec2 centre = vec2(pixel) + 0.5f;
    vec4 result = vec4(0.0f);
    vec2 dominant =
        textureLod(uDominant, tileUv(centre, params.tileSizePx, params.tileCount), 0.0f).xy;
    if (length(dominant) >= kStillPx) {
        vec4 target = textureLod(uMotionDepth, uvAt(centre), 0.0f);
        vec2 motion = clampMotion(target.xy, float(params.tileSizePx));
        uint meshId = textureLod(uMeshId, uvAt(centre), 0.0f).x;
        bool candidate =
            length(motion) >= kStillPx &&
            (revealsAt(centre, motion * params.rasterShare, target.z, meshId) ||
             revealsAt(centre, motion * (params.rasterShare - 1.0f), target.z, meshId));
        result.r = candidate ? 1.0f : 0.0f;
        if (candidate || kMeasureEverywhere != 0u) result.g = measureEdge(centre);
        result.b = candidate && result.g > params.edgeThreshold ? 1.0f : 0.0f;
    } else if (kMeasureEverywhere != 0u) {
        result.g = measureEdge(centre);
    }
    imageStore(uEdge, pixel, result);
}
