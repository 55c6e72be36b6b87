// SPDX-License-Identifier: MIT
// Radiance of a ray's hit, with the shading of the raster image.
#ifndef SHUTTER_SHADE_HIT_GLSL
#define SHUTTER_SHADE_HIT_GLSL

#include "render/hit.glsl"
#include "render/lighting.glsl"

struct ShadedHit {
    vec3 color;
    float alpha; // of blended materials, how much they hide, [0, 1]; 1 for all others
    float light; // share of the colour that reaches the viewer, [0, 1]
    vec3 normal; // camera-relative space, unit, on the viewer's side
    vec3 relWorldPosition;
    vec3 objectPosition;
};

/// \param direction unit, from the camera
/// \param eye place of the camera, camera-relative space
ShadedHit shadeHit(
    FrameRef frame, Hit hit, vec3 direction, vec3 eye, LightSet lights, LightAccess access
) {
    ShadedHit shaded;
    shaded.relWorldPosition = hit.point.relWorldPosition;
    shaded.objectPosition = hit.objectPosition;
    hit.point.relWorldPosition -= eye; // a texture's level follows the distance from the camera
    MaterialRow material = MaterialTable(frame.value.materials).rows[hit.material];
    Surface surface = evaluateSurface(frame, material, hit.point, direction);
    shaded.color =
        shadeSurface(frame, material, surface, shaded.relWorldPosition, direction, lights, access);
    BlendShares shares = blendSharesOf(material.flags, surface.alpha);
    shaded.alpha = shares.opacity;
    shaded.light = shares.light;
    shaded.normal = surface.normal;
    return shaded;
}

/// The same at the raster instant, by the frame's tables.
ShadedHit shadeRasterHit(FrameRef frame, HitId id, vec3 direction) {
    Hit hit = fetchHit(frame, placeAtRaster(frame, id.entity), id);
    return shadeHit(
        frame, hit, direction, vec3(0.0f), lightsAtRaster(frame), lightAccessAnywhere(id.entity)
    );
}

#endif
