// SPDX-License-Identifier: MIT
// The trace layer of ray-tracing pipelines (trace.glsl includes it): for the shader in which rays
// start. trace.rahit, trace.rchit and trace.rmiss are the others.
#ifndef SHUTTER_TRACE_PIPELINE_GLSL
#define SHUTTER_TRACE_PIPELINE_GLSL

#include "render/trace_payload.glsl"

#ifdef SHUTTER_RAY_START

layout(location = 0) rayPayloadEXT TracePayload gTraced;

/// traceRay() through one level.
RayHit traceLevel(
    accelerationStructureEXT level, FrameRef frame, vec3 origin, vec3 direction, float tMin,
    float tMax, uint mask, LeftSurface left
) {
    gTraced.frame = uvec2(frame);
    gTraced.mask = mask;
    gTraced.leftEntity = left.entity;
    gTraced.leftUntil = left.until;
    traceRayEXT(
        level, findRayFlags(mask, left), mask, 0u, 0u, 0u, origin, tMin, direction, tMax, 0
    );
    return RayHit(
        gTraced.found != 0u, gTraced.t,
        HitId(gTraced.entity, gTraced.geometry, gTraced.primitive, gTraced.barycentrics)
    );
}

#endif

#endif
