// SPDX-License-Identifier: MIT
// Rays at the raster instant, and what counts as a hit for rays at any time. Who traces them is a thin
// layer beneath: ray queries, or, where SHUTTER_RAY_PIPELINE is defined, the shaders of a ray-tracing
// pipeline.
#ifndef SHUTTER_TRACE_GLSL
#define SHUTTER_TRACE_GLSL

#ifdef SHUTTER_RAY_PIPELINE
#extension GL_EXT_ray_tracing : require
#else
#extension GL_EXT_ray_query : require
#endif

#include "render/hit.glsl"

/// Maximum number of separate blended surfaces along a ray.
const uint kMaxLayers = 16u;

struct RayHit {
    bool found;
    float t;
    HitId id;
};

/// Whether the entity's blended surfaces are drawn over the picture: rays then miss them.
bool isInLayer(FrameRef frame, uint entity) {
    uvec2 address = frame.value.takenRows;
    if ((address.x | address.y) == 0u) return false;
    return (IndexArray(address).values[entity / 32u] >> (entity & 31u) & 1u) != 0u;
}

/// Whether raster would have drawn the candidate there: back faces of single-sided materials and
/// transparent parts of masked ones are passed.
/// \param direction unit, from the camera
/// \param eye place of the camera, camera-relative space
bool isDrawn(
    FrameRef frame, Placement placement, HitId id, bool frontFace, vec3 direction, vec3 eye,
    uint mask
) {
    uint geometry = placement.firstGeometry + id.geometry;
    uint index = GeometryTable(frame.value.geometries).rows[geometry].material;
    MaterialTable materials = MaterialTable(frame.value.materials);
    uint flags = materials.rows[index].flags;
    uint kind = (flags & kMaterialBlend) != 0u ? kBlendedMask : kSolidMask;
    if ((mask & kind) == 0u) return false;
    if (kind == kBlendedMask && isInLayer(frame, id.entity)) return false;
    if ((flags & kMaterialDoubleSided) == 0u && !frontFace) return false;
    if ((flags & kMaterialMask) == 0u) return true;
    Hit hit = fetchHit(frame, placement, id);
    hit.point.relWorldPosition -= eye;
    return isCovered(frame, materials.rows[index], hit.point, direction);
}

/// The surface from which a ray continues: surfaces of `entity` at t <= `until` are skipped.
/// kNoEntity: none is, and opaque surfaces need no any-hit test.
struct LeftSurface {
    uint entity;
    float until;
};

/// Whether the ray meets the candidate.
/// \param t its distance along the ray
bool isMet(
    FrameRef frame, HitId id, float t, bool frontFace, vec3 direction, uint mask, LeftSurface left
) {
    if (id.entity == left.entity && t <= left.until) return false;
    // An entity without a row is treated as opaque.
    if (!hasEntityRow(frame, id.entity)) return (mask & kSolidMask) != 0u;
    Placement placement = placeAtRaster(frame, id.entity);
    return isDrawn(frame, placement, id, frontFace, direction, vec3(0.0f), mask);
}

uint findRayFlags(uint mask, LeftSurface left) {
    uint flags = gl_RayFlagsCullBackFacingTrianglesEXT;
    // A mesh may have opaque parts besides blended ones: kept out of rays for these. For other rays
    // they are ordinary candidates where their entity has to be tested.
    if ((mask & kSolidMask) == 0u) flags |= gl_RayFlagsCullOpaqueEXT;
    else if (left.entity != kNoEntity) flags |= gl_RayFlagsNoOpaqueEXT;
    return flags;
}

#ifdef SHUTTER_RAY_PIPELINE
#include "render/trace_pipeline.glsl"
#else
#include "render/trace_query.glsl"
#endif

#endif
