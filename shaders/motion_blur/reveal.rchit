// SPDX-License-Identifier: MIT
// The hit of a ray-tracing pipeline's ray.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_ray_tracing : require
#include "render/trace_payload.glsl"

layout(location = 0) rayPayloadInEXT TracePayload gTraced;
hitAttributeEXT vec2 gBarycentrics;

void main() {
    gTraced.found = 1u;
    gTraced.t = gl_HitTEXT;
    gTraced.entity = uint(gl_InstanceCustomIndexEXT);
    gTraced.geometry = uint(gl_GeometryIndexEXT);
    gTraced.primitive = uint(gl_PrimitiveID);
    gTraced.barycentrics = gBarycentrics;
}
