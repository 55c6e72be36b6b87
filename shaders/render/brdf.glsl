// SPDX-License-Identifier: MIT
// glTF 2.0 metallic-roughness (appendix B): Lambert plus GGX with height-correlated Smith
// visibility (Heitz 2014) and Schlick's Fresnel (Schlick 1994).
#ifndef SHUTTER_BRDF_GLSL
#define SHUTTER_BRDF_GLSL

#include "common/numeric.glsl"

SHUTTER_SHADER_BEGIN

SHUTTER_CONST float kPi = 3.14159265f;
/// Smallest perceptual roughness: keeps the highlight's peak inside half floats.
SHUTTER_CONST float kMinRoughness = 0.045f;

SHUTTER_INLINE float distributionGgx(float nDotH, float alpha) {
    float a2 = alpha * alpha;
    float d = (nDotH * a2 - nDotH) * nDotH + 1.0f;
    return a2 / (kPi * d * d);
}

SHUTTER_INLINE float visibilitySmith(float nDotL, float nDotV, float alpha) {
    float a2 = alpha * alpha;
    float l = nDotV * sqrt((nDotL - a2 * nDotL) * nDotL + a2);
    float v = nDotL * sqrt((nDotV - a2 * nDotV) * nDotV + a2);
    return 0.5f / max(l + v, 1.0e-7f);
}

SHUTTER_INLINE vec3 fresnelSchlick(vec3 f0, float vDotH) {
    float x = saturate(1.0f - vDotH);
    float x2 = x * x;
    return f0 + (vec3(1.0f) - f0) * (x2 * x2 * x);
}

/// Share of a uniform environment that a surface mirrors: Karis 2014, "Physically Based Shading on
/// Mobile" (fit of the split-sum table).
SHUTTER_INLINE vec3 environmentBrdf(vec3 f0, float roughness, float nDotV) {
    vec4 c0 = vec4(-1.0f, -0.0275f, -0.572f, 0.022f);
    vec4 c1 = vec4(1.0f, 0.0425f, 1.04f, -0.04f);
    vec4 r = roughness * c0 + c1;
    float a004 = min(r.x * r.x, exp2(-9.28f * nDotV)) * r.x + r.y;
    vec2 ab = vec2(-1.04f, 1.04f) * a004 + vec2(r.z, r.w);
    return f0 * ab.x + vec3(ab.y);
}

/// Reflected radiance for unit irradiance from direction l (all vectors unit, pointing away from the
/// surface); includes the cosine.
SHUTTER_INLINE vec3
reflectLight(vec3 baseColor, float metallic, float roughness, vec3 n, vec3 v, vec3 l) {
    float nDotL = saturate(dot(n, l));
    if (nDotL <= 0.0f) return vec3(0.0f);
    vec3 half_ = v + l;
    vec3 h = half_ * (1.0f / max(length(half_), 1.0e-6f));
    float nDotV = max(abs(dot(n, v)), 1.0e-4f);
    float alpha = roughness * roughness;
    vec3 f = fresnelSchlick(mix(vec3(0.04f), baseColor, metallic), saturate(dot(v, h)));
    vec3 diffuse = baseColor * ((1.0f - metallic) / kPi);
    float specular =
        distributionGgx(saturate(dot(n, h)), alpha) * visibilitySmith(nDotL, nDotV, alpha);
    return ((vec3(1.0f) - f) * diffuse + f * specular) * nDotL;
}

SHUTTER_SHADER_END

#endif
