// SPDX-License-Identifier: MIT
// The one place that traces. Everything else asks traceRay().
#ifndef SHUTTER_TRACE_GLSL
#define SHUTTER_TRACE_GLSL

#extension GL_EXT_ray_query : require

#include "render/hit.glsl"

struct RayHit {
    bool found;
    float t;
    HitId id;
};

/// Nearest surface along the ray with tMin < t < tMax that raster would have drawn: back faces of
/// single-sided materials and transparent parts of masked ones are passed.
/// \param direction unit
RayHit traceRay(
    accelerationStructureEXT scene, FrameRef frame, vec3 origin, vec3 direction, float tMin,
    float tMax
) {
    rayQueryEXT query;
    rayQueryInitializeEXT(
        query, scene, gl_RayFlagsCullBackFacingTrianglesEXT, 0xFF, origin, tMin, direction, tMax
    );
    EntityTable entities = EntityTable(frame.value.entities);
    MaterialTable materials = MaterialTable(frame.value.materials);
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
        Hit hit = fetchHit(frame, entities.rows[id.entity], id);
        MaterialRow material = materials.rows[hit.material];
        if ((material.flags & kMaterialDoubleSided) == 0u &&
            !rayQueryGetIntersectionFrontFaceEXT(query, false))
            continue;
        if ((material.flags & kMaterialMask) != 0u &&
            !isCovered(frame, material, hit.point, direction))
            continue;
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
