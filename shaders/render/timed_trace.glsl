// SPDX-License-Identifier: MIT
// Rays at any shutter time (timed_scene.h has the idea).
#ifndef SHUTTER_MOVING_TRACE_GLSL
#define SHUTTER_MOVING_TRACE_GLSL

#include "render/timed_scene.glsl"
#include "render/ray_triangle.glsl"
#include "render/trace.glsl"

/// A ray query in the moving scene.
struct TimedQuery {
    float s;   // shutter time
    vec3 eye;  // place of the camera, camera-relative space
    uint mask; // kSolidMask, kBlendedMask or both
    float tMin;
    float tMax;
    bool endsAnywhere; // only whether anything solid is met counts, on either side of it
};

uint findTimedFlags(TimedQuery query) {
    return query.endsAnywhere ? gl_RayFlagsTerminateOnFirstHitEXT : gl_RayFlagsCullBackFacingTrianglesEXT;
}

/// A ray in the space of one entity at the ray's own time.
struct ObjectRay {
    bool exists; // false: scaled to nothing at this instant, or NaN: the entity is not there
    vec3 origin;
    vec3 direction; // of any length: t means the same in both spaces
};

ObjectRay makeObjectRay(Placement placement, vec3 origin, vec3 direction) {
    vec4 rows[3] = placement.relWorldFromObject;
    // Columns of the inverse are cross products of the rows over the determinant.
    vec3 c0 = cross(rows[1].xyz, rows[2].xyz);
    vec3 c1 = cross(rows[2].xyz, rows[0].xyz);
    vec3 c2 = cross(rows[0].xyz, rows[1].xyz);
    float determinant = dot(rows[0].xyz, c0);
    float scale = 1.0f / determinant;
    vec3 from = origin - vec3(rows[0].w, rows[1].w, rows[2].w);
    ObjectRay ray;
    ray.origin = (c0 * from.x + c1 * from.y + c2 * from.z) * scale;
    ray.direction = (c0 * direction.x + c1 * direction.y + c2 * direction.z) * scale;
    ray.exists = abs(determinant) > 0.0f && isFinite(dot(ray.origin, ray.origin)) &&
                 isFinite(dot(ray.direction, ray.direction));
    return ray;
}

/// The triangle as it is at the ray's own time.
TriangleHit meetTriangle(FrameRef frame, Placement placement, HitId id, ObjectRay ray) {
    GeometryTable geometries = GeometryTable(frame.value.geometries);
    Geometry geometry = geometries.rows[placement.firstGeometry + id.geometry];
    IndexArray indices = IndexArray(geometry.indices);
    return intersectTriangle(
        ray.origin, ray.direction,
        fetchPosition(geometry, placement, indices.values[3u * id.primitive]),
        fetchPosition(geometry, placement, indices.values[3u * id.primitive + 1u]),
        fetchPosition(geometry, placement, indices.values[3u * id.primitive + 2u])
    );
}

/// Nearest hit within one moving entity; `best` is replaced where there is one before it.
void traceEntity(
    FrameRef frame, TimedRef moving, uint entity, vec3 origin, vec3 direction, TimedQuery query,
    inout RayHit best
) {
    Placement placement = placeAt(moving, entity, query.s);
    ObjectRay ray = makeObjectRay(placement, origin, direction);
    if (!ray.exists) return;
    TimedTable table = TimedTable(moving.value.rows);
    uvec2 address = table.rows[entity].meshScene;
    if (placement.deforms) address = ShapeSceneTable(address).addresses[placement.firstKey];
    // Deforming meshes are hit in boxes: their triangles' facing is computed here, not by the
    // query.
    bool mirrored = table.rows[entity].handedness < 0.0f;
    HitId deformed = HitId(entity, 0u, 0u, vec2(0.0f));
    rayQueryEXT inner;
    rayQueryInitializeEXT(
        inner, accelerationStructureEXT(address), findTimedFlags(query), query.mask,
        ray.origin, query.tMin, ray.direction, best.t
    );
    while (rayQueryProceedEXT(inner)) {
        HitId id = HitId(
            entity, uint(rayQueryGetIntersectionGeometryIndexEXT(inner, false)),
            uint(rayQueryGetIntersectionPrimitiveIndexEXT(inner, false)), vec2(0.0f)
        );
        if (rayQueryGetIntersectionTypeEXT(inner, false) ==
            gl_RayQueryCandidateIntersectionTriangleEXT) {
            id.barycentrics = rayQueryGetIntersectionBarycentricsEXT(inner, false);
            bool frontFace = query.endsAnywhere || rayQueryGetIntersectionFrontFaceEXT(inner, false);
            if (isDrawn(frame, placement, id, frontFace, direction, query.eye, query.mask))
                rayQueryConfirmIntersectionEXT(inner);
            continue;
        }
        TriangleHit hit = meetTriangle(frame, placement, id, ray);
        if (!hit.found || !(hit.t > query.tMin) || !(hit.t < best.t)) continue;
        id.barycentrics = hit.barycentrics;
        bool frontFace = query.endsAnywhere || hit.frontFace != mirrored;
        if (!isDrawn(frame, placement, id, frontFace, direction, query.eye, query.mask)) continue;
        best.found = true;
        best.t = hit.t;
        deformed = id;
        rayQueryGenerateIntersectionEXT(inner, hit.t);
    }
    uint committed = rayQueryGetIntersectionTypeEXT(inner, true);
    if (committed == gl_RayQueryCommittedIntersectionGeneratedEXT) best.id = deformed;
    if (committed != gl_RayQueryCommittedIntersectionTriangleEXT) return;
    best.found = true;
    best.t = rayQueryGetIntersectionTEXT(inner, true);
    best.id = HitId(
        entity, uint(rayQueryGetIntersectionGeometryIndexEXT(inner, true)),
        uint(rayQueryGetIntersectionPrimitiveIndexEXT(inner, true)),
        rayQueryGetIntersectionBarycentricsEXT(inner, true)
    );
}

/// Nearest surface along the ray with tMin < t < tMax that raster would have drawn at shutter time s.
/// \param direction unit
RayHit traceTimedRay(
    accelerationStructureEXT scene, FrameRef frame, TimedRef moving, vec3 origin, vec3 direction,
    TimedQuery query
) {
    rayQueryEXT outer;
    rayQueryInitializeEXT(
        outer, scene, findTimedFlags(query), query.mask, origin, query.tMin,
        direction, query.tMax
    );
    RayHit best; // nearest so far, moving or still
    best.found = false;
    best.t = query.tMax;
    best.id = HitId(kNoEntity, 0u, 0u, vec2(0.0f));
    while (rayQueryProceedEXT(outer)) {
        uint committed = rayQueryGetIntersectionTypeEXT(outer, true);
        if (committed == gl_RayQueryCommittedIntersectionTriangleEXT)
            best.t = min(best.t, rayQueryGetIntersectionTEXT(outer, true));
        if (rayQueryGetIntersectionTypeEXT(outer, false) ==
            gl_RayQueryCandidateIntersectionTriangleEXT) {
            HitId id = HitId(
                uint(rayQueryGetIntersectionInstanceCustomIndexEXT(outer, false)),
                uint(rayQueryGetIntersectionGeometryIndexEXT(outer, false)),
                uint(rayQueryGetIntersectionPrimitiveIndexEXT(outer, false)),
                rayQueryGetIntersectionBarycentricsEXT(outer, false)
            );
            bool frontFace = query.endsAnywhere || rayQueryGetIntersectionFrontFaceEXT(outer, false);
            Placement placement = placeAt(moving, id.entity, query.s);
            if (isDrawn(frame, placement, id, frontFace, direction, query.eye, query.mask))
                rayQueryConfirmIntersectionEXT(outer);
            continue;
        }
        uint box = uint(rayQueryGetIntersectionPrimitiveIndexEXT(outer, false));
        uint entity = BoxTable(moving.value.boxes).rows[box];
        float before = best.t;
        traceEntity(frame, moving, entity, origin, direction, query, best);
        if (best.t < before) rayQueryGenerateIntersectionEXT(outer, best.t);
    }
    uint committed = rayQueryGetIntersectionTypeEXT(outer, true);
    if (committed == gl_RayQueryCommittedIntersectionTriangleEXT) {
        best.found = true;
        best.t = rayQueryGetIntersectionTEXT(outer, true);
        best.id = HitId(
            uint(rayQueryGetIntersectionInstanceCustomIndexEXT(outer, true)),
            uint(rayQueryGetIntersectionGeometryIndexEXT(outer, true)),
            uint(rayQueryGetIntersectionPrimitiveIndexEXT(outer, true)),
            rayQueryGetIntersectionBarycentricsEXT(outer, true)
        );
    }
    return best;
}

#endif
