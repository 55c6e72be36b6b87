// SPDX-License-Identifier: MIT
// From a point on a triangle to what light meets there. Raster and rays both come through here.
#ifndef SHUTTER_SURFACE_GLSL
#define SHUTTER_SURFACE_GLSL

#include "render/scene_bindings.glsl"
#ifdef SHUTTER_SEVERAL_SAMPLES
#include "render/split_samples_shared.h"
#endif
#include "render/texture_lod.glsl"

/// Bias of the level of detail that textures are read at.
#ifndef SHUTTER_LOD_BIAS
#define SHUTTER_LOD_BIAS(frame) frame.value.lodBias
#endif

/// A point on a triangle as raster interpolates it or a ray finds it. Directions need not be unit.
struct SurfacePoint {
    vec3 relWorldPosition;     // camera-relative space, metres
    vec3 geometricNormal; // camera-relative space
    vec3 normal;          // camera-relative space
    vec4 tangent;         // camera-relative space, w handedness
    vec2 uv[2];
    float uvDensity[2];   // area in texture coordinates per square metre
    vec4 color;
#ifdef SHUTTER_SEVERAL_SAMPLES
    vec2 uvPerColumn[2]; // difference to the pixel on the right
    vec2 uvPerRow[2];    // ... and to the one below
#endif
};

struct Surface {
    vec3 baseColor;
    float alpha;
    vec3 normal; // camera-relative space, unit, on the viewer's side
    vec3 geometricNormal; // of the triangle: likewise
    float metallic;
    float roughness;
    float occlusion;
    vec3 emissive;
#ifdef SHUTTER_MASKS_SAMPLES
    uint passing; // a bit for each sample whose alpha reaches the cutoff
#endif
};

/// How a surface is combined with its background.
struct BlendShares {
    float light;   // share of its colour that reaches the viewer, [0, 1]
    float opacity; // share of the background that it hides, [0, 1]
};

/// \param flags of the material
BlendShares blendSharesOf(uint flags, float alpha) {
    float share = saturate(alpha);
    if ((flags & kMaterialBlend) == 0u) return BlendShares(1.0f, 1.0f);
    if ((flags & kMaterialAdd) != 0u) return BlendShares(share, 0.0f);
    if ((flags & kMaterialPremultiplied) != 0u) return BlendShares(1.0f, share);
    return BlendShares(share, share);
}

/// Coordinates in a texture, without its offset. \param uv the vertex's, or a difference
vec2 transformUv(TextureRef ref, vec2 uv) {
    return ref.axes.xy * uv.x + ref.axes.zw * uv.y;
}

vec2 textureUv(TextureRef ref, SurfacePoint point) {
    return transformUv(ref, point.uv[ref.uvSet]) + ref.offset;
}

float textureLevelOf(
    FrameRef frame, TextureRef ref, SurfacePoint point, float footprint, float cosine
) {
    float stretch = abs(ref.axes.x * ref.axes.w - ref.axes.y * ref.axes.z);
    return textureLevel(
        point.uvDensity[ref.uvSet] * stretch, sceneTextureTexels(ref.texture), footprint, cosine,
        SHUTTER_LOD_BIAS(frame)
    );
}

vec4 sampleRef(FrameRef frame, TextureRef ref, SurfacePoint point, float footprint, float cosine) {
    float level = textureLevelOf(frame, ref, point, footprint, cosine);
    return sampleSceneTexture(ref.texture, textureUv(ref, point), level);
}

#ifdef SHUTTER_SEVERAL_SAMPLES
/// Mean over the places of the pixel's samples, one level sharper. The level is whole, so that each
/// lookup reads one level instead of two: the raster takes 6 % less time on lavapipe, films lose at
/// most 0.3 dB.
/// \param least alpha: of the samples that reach it, if any does
/// \param passing a bit for each of these
vec4 sampleColor(
    FrameRef frame, TextureRef ref, SurfacePoint point, float footprint, float cosine, float least,
    out uint passing
) {
    float level = max(floor(textureLevelOf(frame, ref, point, footprint, cosine) - 0.5f), 0.0f);
    vec2 uv = textureUv(ref, point);
    vec2 perColumn = transformUv(ref, point.uvPerColumn[ref.uvSet]);
    vec2 perRow = transformUv(ref, point.uvPerRow[ref.uvSet]);
    vec4 sum = vec4(0.0f);
    passing = 0u;
    for (uint i = 0u; i < kSampleCount; ++i) {
        vec2 fromCentre = placeOfSample(i) - 0.5f;
        vec4 texel = sampleSceneTexture(
            ref.texture, uv + perColumn * fromCentre.x + perRow * fromCentre.y, level
        );
        if (texel.a < least) continue;
        sum += texel;
        passing |= 1u << i;
    }
    return sum / float(max(bitCount(passing), 1));
}

vec4 sampleColor(
    FrameRef frame, TextureRef ref, SurfacePoint point, float footprint, float cosine
) {
    uint passing;
    return sampleColor(frame, ref, point, footprint, cosine, -1.0f, passing);
}
#else
#define sampleColor sampleRef
#endif

/// Width of a pixel at the point, metres.
float pixelFootprint(FrameRef frame, vec3 relWorldPosition) {
    vec2 footprint = frame.value.pixelFootprint;
    return footprint.x * length(relWorldPosition) + footprint.y;
}

/// Unit direction in which the camera sees the point.
vec3 viewDirectionTo(FrameRef frame, vec3 relWorldPosition) {
    bool orthographic = frame.value.pixelFootprint.y > 0.0f;
    return orthographic ? frame.value.forward.xyz : normalize(relWorldPosition);
}

vec4 evaluateBaseColor(
    FrameRef frame, MaterialRow material, SurfacePoint point, float footprint, float cosine
) {
    vec4 color = material.baseColor * point.color;
    if (material.baseColorTexture.texture != kNoTexture)
        color *= sampleColor(frame, material.baseColorTexture, point, footprint, cosine);
    return color;
}

#ifdef SHUTTER_MASKS_SAMPLES
/// Base colour: the mean over the samples whose alpha reaches the cutoff.
/// \param passing a bit for each of them
vec4 evaluateMaskedColor(
    FrameRef frame, MaterialRow material, SurfacePoint point, float footprint, float cosine,
    out uint passing
) {
    vec4 factor = material.baseColor * point.color;
    float cutoff = material.emissiveCutoff.a;
    if (material.baseColorTexture.texture == kNoTexture || factor.a <= 0.0f) {
        passing = factor.a >= cutoff ? (1u << kSampleCount) - 1u : 0u;
        return factor;
    }
    return factor * sampleColor(
        frame, material.baseColorTexture, point, footprint, cosine, cutoff / factor.a, passing
    );
}
#endif

float viewCosine(SurfacePoint point, vec3 viewDirection) {
    float size = length(point.geometricNormal);
    return size > 0.0f ? abs(dot(point.geometricNormal, viewDirection)) / size : 1.0f;
}

/// Alpha test of raster and rays.
bool isCovered(FrameRef frame, MaterialRow material, SurfacePoint point, vec3 viewDirection) {
    float footprint = pixelFootprint(frame, point.relWorldPosition);
    vec4 color =
        evaluateBaseColor(frame, material, point, footprint, viewCosine(point, viewDirection));
    return color.a >= material.emissiveCutoff.a;
}

vec3 safeNormalize(vec3 v, vec3 fallback) {
    float size = length(v);
    return size > 1.0e-20f ? v / size : fallback;
}

/// \param viewDirection unit, from the camera to the point
Surface evaluateSurface(
    FrameRef frame, MaterialRow material, SurfacePoint point, vec3 viewDirection
) {
    float footprint = pixelFootprint(frame, point.relWorldPosition);
    float cosine = viewCosine(point, viewDirection);
    Surface surface;
#ifdef SHUTTER_MASKS_SAMPLES
    vec4 color =
        evaluateMaskedColor(frame, material, point, footprint, cosine, surface.passing);
#else
    vec4 color = evaluateBaseColor(frame, material, point, footprint, cosine);
#endif
    surface.baseColor = color.rgb;
    surface.alpha = color.a;
    surface.metallic = material.surface.x;
    surface.roughness = material.surface.y;
    surface.occlusion = 1.0f;
    surface.emissive = material.emissiveCutoff.rgb;

    vec3 geometricNormal = safeNormalize(point.geometricNormal, -viewDirection);
    vec3 normal = safeNormalize(point.normal, geometricNormal);
    bool lit = (material.flags & kMaterialUnlit) == 0u && (frame.value.flags & kFrameUnlit) == 0u;
    if (lit) {
        if (material.metallicRoughnessTexture.texture != kNoTexture) {
            vec4 texel =
                sampleRef(frame, material.metallicRoughnessTexture, point, footprint, cosine);
            surface.roughness *= texel.g;
            surface.metallic *= texel.b;
        }
        if (material.occlusionTexture.texture != kNoTexture) {
            vec4 texel = sampleRef(frame, material.occlusionTexture, point, footprint, cosine);
            surface.occlusion = 1.0f + material.surface.w * (texel.r - 1.0f);
        }
        if (material.emissiveTexture.texture != kNoTexture)
            surface.emissive *=
                sampleColor(frame, material.emissiveTexture, point, footprint, cosine).rgb;
        if (material.normalTexture.texture != kNoTexture && dot(point.tangent, point.tangent) > 0.5f) {
            vec3 texel = sampleRef(frame, material.normalTexture, point, footprint, cosine).xyz;
            vec3 local = (texel * 2.0f - 1.0f) * vec3(material.surface.z, material.surface.z, 1.0f);
            vec3 tangent = safeNormalize(
                point.tangent.xyz - normal * dot(normal, point.tangent.xyz), vec3(0.0f)
            );
            vec3 bitangent = cross(normal, tangent) * point.tangent.w;
            normal = safeNormalize(
                tangent * local.x + bitangent * local.y + normal * local.z, normal
            );
        }
    }
    // Back faces are lit as if turned round.
    bool isBack = dot(geometricNormal, viewDirection) > 0.0f;
    if (isBack) normal = -normal;
    surface.normal = normal;
    surface.geometricNormal = isBack ? -geometricNormal : geometricNormal;
    surface.roughness = clamp(surface.roughness, 0.0f, 1.0f);
    return surface;
}

#endif
