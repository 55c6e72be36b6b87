// SPDX-License-Identifier: MIT
// Rays at the raster instant, and what counts as a hit for rays at any time.
#ifndef SHUTTER_TRACE_GLSL
#define SHUTTER_TRACE_GLSL

#extension GL_EXT_ray_query : require

#include "render/hit.glsl"

/// Blended surfaces along a ray that are told apart.
const uint kMaxLayers = 16u;

struct RayHit {
    bool found;
    float t;
    HitId id;
};

/// Whether raster would have drawn the candidate there: back faces of single-sided materials and
/// transparent parts of masked ones are passed.
/// \param direction unit, from the camera
/// \param eye place of the camera, eye space
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
    if ((flags & kMaterialDoubleSided) == 0u && !frontFace) return false;
    if ((flags & kMaterialMask) == 0u) return true;
    Hit hit = fetchHit(frame, placement, id);
    hit.point.eyePosition -= eye;
    return isCovered(frame, materials.rows[index], hit.point, direction);
}

/// What a ray goes on from: surfaces of `entity` at t <= `until` are passed.
struct LeftSurface {
    uint entity;
    float until;
};

/// Nearest surface along the ray with tMin < t < tMax that raster would have drawn.
/// \param direction unit
/// \param mask what is met: kSolidMask, kBlendedMask or both
RayHit traceRay(
    accelerationStructureEXT scene, FrameRef frame, vec3 origin, vec3 direction, float tMin,
    float tMax, uint mask, LeftSurface left
) {
    uint flags = gl_RayFlagsCullBackFacingTrianglesEXT;
    // A mesh may have opaque parts besides blended ones: kept out of rays for these, and shown to
    // others like any candidate, since they have to be asked whose they are.
    flags |= (mask & kSolidMask) == 0u ? gl_RayFlagsCullOpaqueEXT : gl_RayFlagsNoOpaqueEXT;
    rayQueryEXT query;
    rayQueryInitializeEXT(query, scene, flags, mask, origin, tMin, direction, tMax);
    while (rayQueryProceedEXT(query)) {
        if (rayQueryGetIntersectionTypeEXT(query, false) !=
            gl_RayQueryCandidateIntersectionTriangleEXT)
            continue;
        HitId id = HitId(
            uint(rayQueryGetIntersectionInstanceCustomIndexEXT(query, false)),
            uint(rayQueryGetIntersectionGeometryIndexEXT(query, false)),
            uint(rayQueryGetIntersectionPrimitiveIndexEXT(query, false)),
            rayQueryGetIntersectionBarycentricsEXT(query, false)
        );
        if (id.entity == left.entity && rayQueryGetIntersectionTEXT(query, false) <= left.until)
            continue;
        bool frontFace = rayQueryGetIntersectionFrontFaceEXT(query, false);
        Placement placement = placeAtRaster(frame, id.entity);
        if (isDrawn(frame, placement, id, frontFace, direction, vec3(0.0f), mask))
            rayQueryConfirmIntersectionEXT(query);
    }
    RayHit result;
    result.found = rayQueryGetIntersectionTypeEXT(query, true) ==
                   gl_RayQueryCommittedIntersectionTriangleEXT;
    if (result.found) {
        result.t = rayQueryGetIntersectionTEXT(query, true);
        result.id = HitId(
            uint(rayQueryGetIntersectionInstanceCustomIndexEXT(query, true)),
            uint(rayQueryGetIntersectionGeometryIndexEXT(query, true)),
            uint(rayQueryGetIntersectionPrimitiveIndexEXT(query, true)),
            rayQueryGetIntersectionBarycentricsEXT(query, true)
        );
    }
    return result;
}

#endif
