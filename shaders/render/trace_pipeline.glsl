// SPDX-License-Identifier: MIT
// The trace layer of ray-tracing pipelines (trace.glsl includes it): for the ray generation shader.
// The pipeline that uses it has the other stages in separate files (motion_blur/reveal.rahit,
// .rchit, .rmiss).
#ifndef SHUTTER_TRACE_PIPELINE_GLSL
#define SHUTTER_TRACE_PIPELINE_GLSL

#include "render/trace_payload.glsl"

#ifdef SHUTTER_RAY_START

layout(location = 0) rayPayloadEXT TracePayload gTraced;

RayHit readTraced() {
    return RayHit(
        gTraced.found != 0u, gTraced.t,
        HitId(gTraced.entity, gTraced.geometry, gTraced.primitive, gTraced.barycentrics)
    );
}

/// Nearest surface along the ray with tMin < t < tMax that raster would have drawn.
/// \param direction unit
/// \param mask what the ray may hit: kSolidMask (or a part of it), kBlendedMask or both
RayHit traceRay(
    accelerationStructureEXT scene, FrameRef frame, vec3 origin, vec3 direction, float tMin,
    float tMax, uint mask, LeftSurface left
) {
    gTraced.frame = uvec2(frame);
    gTraced.mask = mask;
    gTraced.leftEntity = left.entity;
    gTraced.leftUntil = left.until;
    uint flags = findRayFlags(mask, left);
    traceRayEXT(scene, flags, mask, 0u, 0u, 0u, origin, tMin, direction, tMax, 0);
    RayHit nearest = readTraced();
    // Movers may be in a separate TLAS (FrameConstants::movingTlas).
    uvec2 movingTlas = frame.value.movingTlas;
    if ((movingTlas.x | movingTlas.y) == 0u) return nearest;
    float end = nearest.found ? nearest.t : tMax;
    traceRayEXT(
        accelerationStructureEXT(movingTlas), flags, mask, 0u, 0u, 0u, origin, tMin, direction, end,
        0
    );
    RayHit moving = readTraced();
    if (moving.found) nearest = moving;
    return nearest;
}

#endif

#endif
