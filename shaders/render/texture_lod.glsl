// SPDX-License-Identifier: MIT
// Texture level of detail that raster and rays compute alike: from the triangle's texture density
// and the pixel's footprint on it (ray cones, Akenine-Moeller et al. 2021, "Improved Shader and
// Texture Level of Detail Using Ray Cones", with the footprint's area instead of its long axis).
#ifndef SHUTTER_TEXTURE_LOD_GLSL
#define SHUTTER_TEXTURE_LOD_GLSL

#include "common/numeric.glsl"

SHUTTER_SHADER_BEGIN

/// Area in texture coordinates per square metre of a triangle, from two of its edges (or from any
/// two displacements in its plane, such as screen-space derivatives: the ratio is the same).
SHUTTER_INLINE float textureDensity(vec3 edge1, vec3 edge2, vec2 uvEdge1, vec2 uvEdge2) {
    float area = length(cross(edge1, edge2));
    float uvArea = abs(uvEdge1.x * uvEdge2.y - uvEdge1.y * uvEdge2.x);
    return uvArea / max(area, 1.0e-30f);
}

/// \param density texture coordinates' area per square metre
/// \param texels width times height of level 0
/// \param footprint width of the pixel at the surface's distance, metres
/// \param cosine |cos| of the angle between the surface's normal and the view ray
SHUTTER_INLINE float
textureLevel(float density, float texels, float footprint, float cosine, float bias) {
    float covered = density * texels * footprint * footprint / max(cosine, 0.01f);
    return max(0.5f * log2(max(covered, 1.0e-20f)) + bias, 0.0f);
}

SHUTTER_SHADER_END

#endif
