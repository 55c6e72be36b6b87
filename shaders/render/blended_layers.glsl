// SPDX-License-Identifier: MIT
// Blended surfaces before one that a ray has found, at the raster instant.
#ifndef SHUTTER_BLENDED_LAYERS_GLSL
#define SHUTTER_BLENDED_LAYERS_GLSL

#include "render/shade_hit.glsl"
#include "render/trace.glsl"

/// Composites the blended surfaces in front of distance `t` of the ray over `color`, as the raster
/// does by drawing them far to near.
/// \param direction unit, from the camera
/// \param absent entity to ignore, including its blended parts; kNoEntity: none
vec3 seenThroughBlended(
    accelerationStructureEXT scene, FrameRef frame, vec3 origin, vec3 direction, float t, uint absent,
    vec3 color
) {
    vec3 sum = vec3(0.0f);
    float transmitted = 1.0f;
    float tMin = 0.0f;
    for (uint layer = 0u; layer < kMaxLayers; ++layer) {
        RayHit hit = traceRay(
            scene, frame, origin, direction, tMin, t, kBlendedMask, LeftSurface(absent, 1.0e30f)
        );
        if (!hit.found) break;
        tMin = hit.t; // the surface itself is excluded: the interval is open
        ShadedHit shaded = shadeRasterHit(frame, hit.id, direction);
        sum += transmitted * shaded.light * shaded.color;
        transmitted *= 1.0f - shaded.alpha;
    }
    return sum + transmitted * color;
}

#endif
