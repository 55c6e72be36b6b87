// SPDX-License-Identifier: MIT
// The trace layer of ray queries (trace.glsl includes it).
#ifndef SHUTTER_TRACE_QUERY_GLSL
#define SHUTTER_TRACE_QUERY_GLSL

/// traceRay() through one level.
RayHit traceLevel(
    accelerationStructureEXT level, FrameRef frame, vec3 origin, vec3 direction, float tMin,
    float tMax, uint mask, LeftSurface left
) {
    rayQueryEXT query;
    rayQueryInitializeEXT(
        query, level, findRayFlags(mask, left), mask, origin, tMin, direction, tMax
    );
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
        float t = rayQueryGetIntersectionTEXT(query, false);
        bool frontFace = rayQueryGetIntersectionFrontFaceEXT(query, false);
        if (isMet(frame, id, t, frontFace, direction, mask, left))
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
