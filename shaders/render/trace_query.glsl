// SPDX-License-Identifier: MIT
// The trace layer of ray queries (trace.glsl includes it).
#ifndef SHUTTER_TRACE_QUERY_GLSL
#define SHUTTER_TRACE_QUERY_GLSL

/// Nearest surface along the ray with tMin < t < tMax that raster would have drawn.
/// \param direction unit
/// \param mask what the ray may hit: kSolidMask (or a part of it), kBlendedMask or both
RayHit traceRay(
    accelerationStructureEXT scene, FrameRef frame, vec3 origin, vec3 direction, float tMin,
    float tMax, uint mask, LeftSurface left
) {
    RayHit result;
    result.found = false;
    // Movers may be in a separate TLAS (FrameConstants::movingTlas).
    uvec2 movingTlas = frame.value.movingTlas;
    uint levels = (movingTlas.x | movingTlas.y) != 0u ? 2u : 1u;
    uint flags = findRayFlags(mask, left);
    for (uint level = 0u; level < levels; ++level) {
        float end = result.found ? result.t : tMax;
        rayQueryEXT query;
        if (level == 0u)
            rayQueryInitializeEXT(query, scene, flags, mask, origin, tMin, direction, end);
        else
            rayQueryInitializeEXT(
                query, accelerationStructureEXT(movingTlas), flags, mask, origin, tMin, direction,
                end
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
        if (rayQueryGetIntersectionTypeEXT(query, true) !=
            gl_RayQueryCommittedIntersectionTriangleEXT)
            continue;
        result.found = true;
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
