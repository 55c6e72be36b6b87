// SPDX-License-Identifier: MIT
// What a particle covers of a pixel's centre, mean over a part of the exposure: premultiplied.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "render/particle.glsl"

layout(binding = 0) uniform sampler2D uMotionDepth;

layout(location = 0) in vec2 inTextureUv;
layout(location = 1) flat in vec4 inShape;
layout(location = 2) flat in uint inTexture;
layout(location = 3) flat in vec4 inPoints[5];
layout(location = 8) flat in vec4 inColors[5];

layout(location = 0) out vec4 outColor;

/// Metres along the view to the surface behind the pixel.
float surfaceDepth() { return texelFetch(uMotionDepth, ivec2(gl_FragCoord.xy), 0).z; }

/// How much of a particle lies before the surface.
float showBefore(float surface, float depth, float softMetres) {
    float before = surface - depth;
    if (softMetres <= 0.0f) return before > 0.0f ? 1.0f : 0.0f;
    return saturate(before / softMetres);
}

void main() {
    float surface = surfaceDepth();
    uint segments = uint(inShape.w);
    vec4 sum = vec4(0.0f);
    if (inTexture != kNoParticleTexture) {
        vec4 texel = sampleSceneTexture(inTexture, inTextureUv, inShape.x);
        sum = inColors[0] * vec4(texel.rgb * texel.a, texel.a) *
              showBefore(surface, inPoints[0].w, inShape.y);
    } else {
        for (uint i = 0u; i < segments; ++i) {
            vec2 point = gl_FragCoord.xy - inPoints[i].xy;
            vec2 way = inPoints[i + 1u].xy - inPoints[i].xy;
            float nearest = saturate(dot(point, way) / max(dot(way, way), 1.0e-6f));
            float radius = mix(inPoints[i].z, inPoints[i + 1u].z, nearest);
            vec2 covered = streakCoverage(point, way, radius);
            if (covered.x <= 0.0f) continue;
            float depth = mix(inPoints[i].w, inPoints[i + 1u].w, covered.y);
            sum += mix(inColors[i], inColors[i + 1u], covered.y) *
                   (covered.x * showBefore(surface, depth, inShape.y));
        }
        sum /= float(max(segments, 1u));
    }
    sum *= inShape.z;
    outColor = vec4(storableColor(sum.rgb), saturate(sum.a));
}
