// SPDX-License-Identifier: MIT
// Payload shared by the shaders of a ray-tracing pipeline.
#ifndef SHUTTER_TRACE_PAYLOAD_GLSL
#define SHUTTER_TRACE_PAYLOAD_GLSL

struct TracePayload {
    uvec2 frame;     // to the candidates' shader: address of FrameConstants,
    uint mask;       // what the ray may hit
    uint leftEntity; // and the surface to pass: LeftSurface
    float leftUntil;
    uint found; // back: 1 where it hit
    float t;
    uint entity; // HitId
    uint geometry;
    uint primitive;
    vec2 barycentrics;
};

#endif
