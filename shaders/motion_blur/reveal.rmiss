// SPDX-License-Identifier: MIT
// A ray of a ray-tracing pipeline that meets nothing.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_ray_tracing : require
#include "render/trace_payload.glsl"

layout(location = 0) rayPayloadInEXT TracePayload gTraced;

void main() { gTraced.found = 0u; }
