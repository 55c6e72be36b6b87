// SPDX-License-Identifier: MIT
// A particle's coverage of a pixel's centre, mean over a part of the exposure: premultiplied.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "common/instant_surfaces.glsl"
#include "render/particle.glsl"

layout(binding = 0) uniform sampler2D uMotionDepth; // of the raster
layout(binding = 1, scalar) readonly buffer Surfaces {
    InstantSurfaces uHead;
    uint uWords[];
};

layout(location = 0) in vec2 inTextureUv;
layout(location = 1) flat in vec4 inShape;
layout(location = 2) flat in uint inTexture;
layout(location = 3) flat in vec4 inPoints[5];
layout(location = 8) flat in vec4 inColors[5];
layout(location = 13) flat in vec2 inLight;

layout(location = 0) out vec4 outColor;

/// How much of a particle lies before the surface.
float showBefore(float surface, float depth, float softMetres) {
    float before = surface - depth;
    if (softMetres <= 0.0f) return before > 0.0f ? 1.0f : 0.0f;
    return saturate(before / softMetres);
}

/// The same at the instants of a part of the light, in which its depth goes from x to y: their mean.
/// \param surface behind the pixel in the raster, metres along the view
float showAtInstants(uvec2 at, float surface, vec2 depths, vec2 light, float softMetres) {
    float count = float(uHead.instantCount);
    // Those whose middles lie in the part; of a shorter part, the one that holds its own.
    uint first = uint(light.x * count + 0.5f);
    uint end = min(uint(light.y * count + 0.5f), uHead.instantCount);
    if (first >= end) {
        first = min(uint(0.5f * (light.x + light.y) * count), uHead.instantCount - 1u);
        end = first + 1u;
    }
    float rounded = unpackHalf2x16(packHalf2x16(vec2(surface))).x;
    float sum = 0.0f;
    for (uint i = first; i < end; ++i) {
        vec2 pair = unpackHalf2x16(uWords[surfaceDepthWord(uHead, i, at)]);
        float hiding = (i & 1u) == 0u ? pair.x : pair.y;
        // Static surfaces hide particles as outside of the rectangle.
        if (hiding == rounded) hiding = surface;
        float passed = (float(i) + 0.5f) / count - light.x;
        float depth = mix(depths.x, depths.y, saturate(passed / max(light.y - light.x, 1.0e-6f)));
        sum += showBefore(hiding, depth, softMetres);
    }
    return sum / float(end - first);
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    float surface = texelFetch(uMotionDepth, pixel, 0).z;
    uvec2 at = uvec2(pixel) - uHead.originPx;
    bool readsInstants = kReadsInstants && all(lessThan(at, uHead.sizePx));
    uint segments = uint(inShape.w);
    vec4 sum = vec4(0.0f);
    if (inTexture != kNoParticleTexture) {
        vec4 texel = sampleSceneTexture(inTexture, inTextureUv, inShape.x);
        float shown = readsInstants
                          ? showAtInstants(at, surface, inPoints[0].ww, inLight, inShape.y)
                          : showBefore(surface, inPoints[0].w, inShape.y);
        sum = inColors[0] * vec4(texel.rgb * texel.a, texel.a) * shown;
    } else {
        for (uint i = 0u; i < segments; ++i) {
            vec2 point = gl_FragCoord.xy - inPoints[i].xy;
            vec2 way = inPoints[i + 1u].xy - inPoints[i].xy;
            float nearest = saturate(dot(point, way) / max(dot(way, way), 1.0e-6f));
            float radius = mix(inPoints[i].z, inPoints[i + 1u].z, nearest);
            vec2 covered = streakCoverage(point, way, radius);
            if (covered.x <= 0.0f) continue;
            float shown;
            if (readsInstants) {
                vec2 span = streakSpan(point, way, radius);
                vec2 depths = mix(inPoints[i].ww, inPoints[i + 1u].ww, span);
                vec2 light = mix(inLight.xx, inLight.yy, (float(i) + span) / float(segments));
                shown = showAtInstants(at, surface, depths, light, inShape.y);
            } else {
                float depth = mix(inPoints[i].w, inPoints[i + 1u].w, covered.y);
                shown = showBefore(surface, depth, inShape.y);
            }
            sum += mix(inColors[i], inColors[i + 1u], covered.y) * (covered.x * shown);
        }
        sum /= float(max(segments, 1u));
    }
    sum *= inShape.z;
    outColor = vec4(storableColor(sum.rgb), saturate(sum.a));
}
