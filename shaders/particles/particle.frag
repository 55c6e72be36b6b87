// SPDX-License-Identifier: MIT
// A particle's coverage of a pixel's centre, mean over a part of the exposure: premultiplied.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "common/instant_surfaces.glsl"
#include "particles/particle.glsl"

layout(binding = 0) uniform sampler2D uMotionDepth; // of the raster
layout(binding = 1, scalar) readonly buffer Surfaces {
    InstantSurfaces uHead;
    uint uWords[];
};

layout(location = 0) in vec2 inTextureUv;
layout(location = 1) flat in vec4 inShape;
layout(location = 2) flat in uvec4 inKind;
layout(location = 3) flat in vec4 inPoints[5];
layout(location = 8) flat in vec4 inColors[5];
layout(location = 13) flat in vec3 inTimes;
layout(location = 14) flat in vec2 inTurn;

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

struct Background {
    uvec2 at;
    float surface;     // behind the pixel in the raster, metres along the view
    bool readsInstants;
};

/// How much of a particle is seen while its depth goes from x to y and the light between x and y is
/// taken.
float showDuring(Background background, vec2 depths, vec2 light) {
    return background.readsInstants
               ? showAtInstants(background.at, background.surface, depths, light, inShape.y)
               : showBefore(background.surface, 0.5f * (depths.x + depths.y), inShape.y);
}

/// Premultiplied. What is too small for a pixel's centre to meet it is drawn larger: as bright, spread
/// over more.
vec4 paint(vec4 color, float radius, float drawnRadius) {
    float shrunk = min(radius / drawnRadius, 1.0f);
    float alpha = color.a * shrunk * shrunk;
    return vec4(color.rgb * alpha, (inKind.y & kParticleAdd) != 0u ? 0.0f : alpha);
}

/// Mean over a segment in which neither size nor colour changes much, as its part of the light.
vec4 drawSteady(uint i, vec2 light, Background background) {
    vec2 point = gl_FragCoord.xy - inPoints[i].xy;
    vec2 way = inPoints[i + 1u].xy - inPoints[i].xy;
    float nearest = saturate(dot(point, way) / max(dot(way, way), 1.0e-6f));
    float seen = mix(inPoints[i].z, inPoints[i + 1u].z, nearest);
    float radius = max(seen, kMinParticleRadiusPx);
    vec2 covered = streakCoverage(point, way, radius);
    if (covered.x <= 0.0f) return vec4(0.0f);
    vec2 span = background.readsInstants ? streakSpan(point, way, radius, radius) : covered.yy;
    float shown = showDuring(
        background, mix(inPoints[i].ww, inPoints[i + 1u].ww, span), mix(light.xx, light.yy, span)
    );
    return paint(mix(inColors[i], inColors[i + 1u], covered.y), seen, radius) * (covered.x * shown);
}

/// The sum of light over a segment in which size or colour changes.
vec4 drawChanging(uint i, vec2 times, Background background) {
    vec2 point = gl_FragCoord.xy - inPoints[i].xy;
    vec2 way = inPoints[i + 1u].xy - inPoints[i].xy;
    vec2 radii = max(vec2(inPoints[i].z, inPoints[i + 1u].z), kMinParticleRadiusPx);
    vec2 span = streakSpan(point, way, radii.x, radii.y);
    if (!(span.x < span.y)) return vec4(0.0f);
    vec4 sum = vec4(0.0f);
    for (uint node = 0u; node < kStreakNodes; ++node) {
        vec2 at = streakNode(span, radii.x, radii.y, node);
        float radius = mix(radii.x, radii.y, at.x);
        vec2 apart = (point - way * at.x) / radius;
        float weight = roundProfile(dot(apart, apart)) * at.y * lightDensity(mix(times.x, times.y, at.x));
        if (!background.readsInstants) {
            float depth = mix(inPoints[i].w, inPoints[i + 1u].w, at.x);
            weight *= showBefore(background.surface, depth, inShape.y);
        }
        float seen = mix(inPoints[i].z, inPoints[i + 1u].z, at.x);
        sum += paint(mix(inColors[i], inColors[i + 1u], at.x), seen, radius) * weight;
    }
    if (background.readsInstants) {
        vec2 ends = mix(times.xx, times.yy, span);
        sum *= showDuring(
            background, mix(inPoints[i].ww, inPoints[i + 1u].ww, span),
            vec2(lightBefore(ends.x), lightBefore(ends.y))
        );
    }
    return sum * (times.y - times.x);
}

/// \param light that is taken before the first, the middle and the last point
vec4 drawStreak(uint segments, vec3 light, Background background) {
    if (segments == 1u && inKind.z == 0u) return drawSteady(0u, light.xz, background);
    vec4 sum = vec4(0.0f);
    for (uint i = 0u; i < segments; ++i) {
        if (inKind.z != 0u) {
            vec2 times = vec2(cutSpan(inTimes, segments, i), cutSpan(inTimes, segments, i + 1u));
            sum += drawChanging(i, times, background);
        } else {
            vec2 ends = vec2(cutSpan(light, segments, i), cutSpan(light, segments, i + 1u));
            sum += drawSteady(i, ends, background) * (ends.y - ends.x);
        }
    }
    return sum / max(light.z - light.x, 1.0e-20f);
}

/// Mean of a picture at `times` times at which equal parts of the light have been taken.
vec4 drawPicture(uint segments, uint times, vec3 light, Background background) {
    vec4 sum = vec4(0.0f);
    for (uint time = 0u; time < times; ++time) {
        vec2 ends = mix(light.xx, light.zz, vec2(time, time + 1u) / float(times));
        float s = respondAt(draw.response, 0.5f * (ends.x + ends.y));
        uint i = 0u;
        while (i + 1u < segments && cutSpan(inTimes, segments, i + 1u) <= s) ++i;
        vec2 around = vec2(cutSpan(inTimes, segments, i), cutSpan(inTimes, segments, i + 1u));
        float share = saturate((s - around.x) / max(around.y - around.x, 1.0e-20f));
        vec4 point = mix(inPoints[i], inPoints[i + 1u], share);
        float angle = inTurn.x + inTurn.y * s;
        float radius = max(point.z, kMinParticleRadiusPx);
        vec2 apart = (gl_FragCoord.xy - point.xy) / radius;
        vec2 uv = vec2(dot(apart, vec2(cos(angle), sin(angle))), dot(apart, vec2(-sin(angle), cos(angle))));
        if (any(greaterThan(abs(uv), vec2(1.0f)))) continue;
        vec4 texel = sampleSceneTexture(inKind.x, 0.5f * uv + 0.5f, inShape.x);
        sum += paint(mix(inColors[i], inColors[i + 1u], share), point.z, radius) *
               vec4(texel.rgb * texel.a, texel.a) * showDuring(background, point.ww, ends);
    }
    return sum / float(times);
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    Background background;
    background.surface = texelFetch(uMotionDepth, pixel, 0).z;
    background.at = uvec2(pixel) - uHead.originPx;
    background.readsInstants = kReadsInstants && all(lessThan(background.at, uHead.sizePx));
    uint segments = uint(inShape.w);
    vec3 light = vec3(lightBefore(inTimes.x), lightBefore(inTimes.y), lightBefore(inTimes.z));
    vec4 sum;
    if (inKind.x == kNoParticleTexture) {
        sum = drawStreak(segments, light, background);
    } else if (inKind.w > 1u) {
        sum = drawPicture(segments, inKind.w, light, background);
    } else {
        vec4 texel = sampleSceneTexture(inKind.x, inTextureUv, inShape.x);
        sum = paint(inColors[0], inPoints[0].z, max(inPoints[0].z, kMinParticleRadiusPx)) *
              vec4(texel.rgb * texel.a, texel.a) *
              showDuring(background, inPoints[0].ww, light.xz);
    }
    sum *= inShape.z;
    outColor = vec4(storableColor(sum.rgb), saturate(sum.a));
}
