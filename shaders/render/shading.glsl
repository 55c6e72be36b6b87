// SPDX-License-Identifier: MIT
// Composes shading from the features that take part in it: the one file of this folder that may
// include theirs, since GLSL has no late binding and rays shade their hits by the same code.
#ifndef SHUTTER_SHADING_GLSL
#define SHUTTER_SHADING_GLSL

#include "render/changing_tiles.glsl"
#include "shadows/shadow_lookup.glsl"

/// How a point finds which lights reach it.
struct LightAccess {
    bool byTables;    // the frame's tables, where it has any; else `dark`
    uint dark;        // a bit for each light that does not reach the point
    uint receiver;    // row of the entity table
    uint mayOcclude;  // a bit for each moving occluder that may hold light back
};

/// Of a pixel of the raster.
LightAccess lightAccessAt(FrameRef frame, uint entity, vec2 pixel) {
    return LightAccess(true, 0u, entity, changesOfTile(frame, pixel));
}

/// Of any point.
LightAccess lightAccessAnywhere(uint entity) {
    return LightAccess(true, 0u, entity, ~0u);
}

/// \param dark a bit for each light that rays found to be hidden
LightAccess lightAccessByRays(uint entity, uint dark) {
    return LightAccess(false, dark, entity, 0u);
}

/// Visibility of a light at a point, [0, 1], at the raster instant or over the exposure.
/// \param index of the light
/// \param normal of the triangle, unit, on the viewer's side
/// \param toLight unit
float lightReaching(
    FrameRef frame, LightAccess access, uint index, LightRow light, vec3 position, vec3 normal,
    vec3 toLight
) {
    if (index >= kMaxOccludedLights) return 1.0f;
    if (!access.byTables) return (access.dark >> index & 1u) != 0u ? 0.0f : 1.0f;
    Receiver receiver;
    receiver.position = position;
    receiver.toLight = toLight;
    receiver.normal = dot(normal, toLight) < 0.0f ? -normal : normal;
    receiver.distance_ = light.kind == kLightDirectional
                             ? 1.0e15f
                             : distance(light.positionRange.xyz, position);
    receiver.pixel = pixelFootprint(frame, position);
    receiver.entity = access.receiver;
    return lightThroughMaps(frame, index, light, receiver, access.mayOcclude);
}

#endif
