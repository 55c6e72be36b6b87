// SPDX-License-Identifier: MIT
// Lookup positions and filtering of shadow maps. No bindings: unit tests run it too.
#ifndef SHUTTER_SHADOW_FILTER_GLSL
#define SHUTTER_SHADOW_FILTER_GLSL

#include "common/numeric.glsl"
#include "shadows/shadow_shared.h"

SHUTTER_SHADER_BEGIN

/// Steepest that the filter's edges are made: thin casters and corners suffer from more.
SHUTTER_CONST float kMaxEdgeContrast = 3.0f;

/// Beyond 87 degrees from the light a plane's slope is worth less than its rounding.
SHUTTER_CONST float kMinSlopeCosine = 0.05f;

/// Offset of a point from its surface before the lookup, for errors beyond its plane: curvature,
/// and rounding (Holbert 2011, "Saying Goodbye to Shadow Acne", normal offset).
/// \return metres
/// \param cosine of the angle between normal and light
SHUTTER_INLINE float normalOffset(float texelMetres, float cosine) {
    float sine = sqrt(max(1.0f - cosine * cosine, 0.0f));
    return texelMetres * (0.5f * sine + 0.05f);
}

/// How a plane's depth changes from texel to texel of the map of a light at a place, towards x and y
/// (Isidoro 2006, "Shadow Mapping: GPU-based Tips and Techniques", receiver plane depth bias). Exact:
/// near / distance is linear in the map. 0 for a plane that the light sees from its edge.
/// \param clip of a point of the plane; clipNormal: of its unit normal, w 0
/// \param cosine of the angle between the normal and the way to the light
/// \param texelMetres ShadowMap's
SHUTTER_INLINE vec2
planeSlope(vec4 clip, vec4 clipNormal, float cosine, float texelMetres, uint sizePx) {
    if (!(cosine > kMinSlopeCosine)) return vec2(0.0f);
    float half_ = 0.5f * texelMetres * float(sizePx); // of the map's width, at w = 1
    vec2 across = vec2(clipNormal.x, clipNormal.y);
    // Distance of the plane from the light.
    float away = half_ * half_ * (clipNormal.x * clip.x + clipNormal.y * clip.y) +
                 clipNormal.w * clip.w;
    if (!(abs(away) > 1.0e-30f)) return vec2(0.0f);
    return across * (half_ * texelMetres * clip.z / away);
}

/// Quadratic B-spline over three texels: shadows' edges have no steps.
/// \param offset from the middle texel's centre, texels, [-0.5, 0.5]
SHUTTER_INLINE vec3 splineWeights(float offset) {
    float before = 0.5f - offset;
    float after = 0.5f + offset;
    return vec3(0.5f * before * before, 0.75f - offset * offset, 0.5f * after * after);
}

/// A place in a map.
struct ShadowPlace {
    vec2 texel;      // from the map's corner
    float depth;     // of the receiver, biased
    vec2 slope;      // of its depth, a texel
    float scale;     // of ShadowMap::texelMetres there
    bool isCovered;  // the map has all texels that the filter reads
};

/// Whether a map has all texels that the filter reads around a place. NaN is not covered.
SHUTTER_INLINE bool coversFilter(vec2 texel, float size) {
    return texel.x >= kShadowFilterTexels && texel.y >= kShadowFilterTexels &&
           texel.x <= size - kShadowFilterTexels && texel.y <= size - kShadowFilterTexels;
}

/// \param clip the receiver's; w above 0 is in front of the light
/// \param slope planeSlope()'s
SHUTTER_INLINE ShadowPlace placeInMap(vec4 clip, vec2 slope, uint sizePx) {
    ShadowPlace place;
    place.slope = slope;
    place.scale = clip.w;
    float size = float(sizePx);
    place.isCovered = clip.w > 0.0f;
    float scale = 1.0f / max(clip.w, 1.0e-30f);
    place.texel = (vec2(clip.x, clip.y) * scale * 0.5f + 0.5f) * size;
    place.depth = clip.z * scale * (1.0f + kDepthScaleRounding);
    place.isCovered = place.isCovered && coversFilter(place.texel, size);
    return place;
}

/// Transmitted share of a row of three texels. Depth 0 means no caster.
SHUTTER_INLINE float lightThrough(vec3 casters, vec3 weights, vec3 depths) {
    vec3 at = max(depths, vec3(1.0e-30f));
    return (casters.x > at.x ? 0.0f : weights.x) + (casters.y > at.y ? 0.0f : weights.y) +
           (casters.z > at.z ? 0.0f : weights.z);
}

/// The weights of nine texels need not add up to exactly 1: rounding must neither darken fully lit
/// points nor light fully dark ones.
SHUTTER_INLINE float settleLight(float sum) {
    float rounding = 1.0e-6f;
    if (sum < rounding) return 0.0f;
    return sum > 1.0f - rounding ? 1.0f : sum;
}

/// Which of a point light's six maps sees a direction: +x -x +y -y +z -z.
SHUTTER_INLINE uint cubeFace(vec3 direction) {
    vec3 a = abs(direction);
    if (a.x >= a.y && a.x >= a.z) return direction.x >= 0.0f ? 0u : 1u;
    if (a.y >= a.z) return direction.y >= 0.0f ? 2u : 3u;
    return direction.z >= 0.0f ? 4u : 5u;
}

/// Whether the way from a point to the light passes through a sphere.
/// \param toLight unit
/// \param distance_ to the light, metres
SHUTTER_INLINE bool meetsSphere(vec3 point, vec3 toLight, float distance_, vec4 sphere) {
    vec3 offset = vec3(sphere) - point;
    float along = dot(offset, toLight);
    if (along < -sphere.w || along > distance_ + sphere.w) return false;
    vec3 across = offset - toLight * along;
    return dot(across, across) <= sphere.w * sphere.w;
}

/// Share of light, sharpened: the filter is as soft as 4/3 texels are wide, which is seen where
/// texels are larger than pixels. The middle of a soft edge is where the edge is.
/// \param texelsPerPixel below 1 where a texel is larger than a pixel
SHUTTER_INLINE float sharpenEdge(float light, float texelsPerPixel) {
    float contrast = clamp(1.3333f / max(texelsPerPixel, 1.0e-6f), 1.0f, kMaxEdgeContrast);
    return clamp((light - 0.5f) * contrast + 0.5f, 0.0f, 1.0f);
}

/// The form whose unit ellipsoid is a mover's box, applied to a vector.
SHUTTER_INLINE vec3 applyShape(vec4 shape[3], vec3 v) {
    return vec3(dot(vec3(shape[0]), v), dot(vec3(shape[1]), v), dot(vec3(shape[2]), v));
}

/// Where a point lies in a map of a light that is far away. \param point along the light's axes
SHUTTER_INLINE vec2 findTexel(ShadowCascade cascade, vec3 point) {
    return vec2(point.x, point.y) * cascade.texelsPerMetre + cascade.corner;
}

/// Whether the map has the texels around a point, and still has them if it is lifted. NaN: it has not.
SHUTTER_INLINE bool hasPoint(ShadowCascade cascade, vec3 point) {
    // Off its surface it moves by 0.55 texels at most: see normalOffset().
    vec2 texel = findTexel(cascade, point);
    float margin = kShadowFilterTexels + 1.0f;
    float most = float(cascade.sizePx) - margin;
    return texel.x >= margin && texel.y >= margin && texel.x <= most && texel.y <= most;
}

/// Lookup position of a receiver within the map, offset from its surface.
/// \param point, normal along the light's axes; normal unit, its z above or at 0
SHUTTER_INLINE ShadowPlace placeInCascade(ShadowCascade cascade, vec3 point, vec3 normal) {
    vec3 lifted = point + normal * normalOffset(1.0f / cascade.texelsPerMetre, normal.z);
    ShadowPlace place;
    place.texel = findTexel(cascade, lifted);
    place.depth = lifted.z * cascade.depthPerMetre + cascade.depth;
    place.slope = vec2(0.0f);
    if (normal.z > kMinSlopeCosine)
        place.slope = vec2(normal.x, normal.y) *
                      (-cascade.depthPerMetre / (cascade.texelsPerMetre * normal.z));
    place.scale = 1.0f;
    place.isCovered = true;
    return place;
}

/// The slope of a plane's depth in a run's layer, a texel towards x and y; see planeSlope().
/// \param run CasterSpan::slope
SHUTTER_INLINE vec2 planeSlopeOnRun(vec4 run[2], vec3 normal, float cosine) {
    if (!(cosine > kMinSlopeCosine)) return vec2(0.0f);
    return vec2(dot(vec3(run[0]), normal), dot(vec3(run[1]), normal)) / cosine;
}

/// Lookup position of a receiver in a mover's layer, for a point light. The layer was drawn from
/// `light`, and at the instant in question the light is at `seen` in the mover's space. The ray is
/// remapped around the point where it is deepest in the mover's ellipsoid: for a flat mover, where
/// it crosses the plane, which is exact; for a round one, where it passes the centre. Only outlines
/// from elsewhere in the mover are those of the layer. (extract::mapToLayer() does the same for a
/// directional light.)
/// \param shape ShadowMover's
/// \return w 0: the receiver is not in front of the light in the mover's space; else 1
SHUTTER_INLINE vec4
alignPointRay(vec3 point, vec3 seen, vec3 light, vec3 centre, vec4 shape[3]) {
    vec3 way = seen - point;
    vec3 weighed = applyShape(shape, way);
    float along = dot(centre - point, weighed) / max(dot(way, weighed), 1.0e-30f); // 1: the light
    if (!(along < 0.999f)) return vec4(0.0f);
    vec3 deepest = point + way * along;
    return vec4(light + (deepest - light) / (1.0f - along), 1.0f);
}

SHUTTER_SHADER_END

#endif
