// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
#include "render/environment.glsl"
#include "render/sky.glsl"
#include "render/view_ray.glsl"

layout(push_constant, scalar) uniform Push { DrawConstants draw; };

layout(location = 0) out vec4 outColor;
layout(location = 1) out vec4 outNormal;
layout(location = 2) out vec4 outMotionDepth;
layout(location = 3) out uint outEntityId;

void main() {
    FrameRef frame = FrameRef(draw.frame);
    ViewRay ray = makeViewRay(frame, gl_FragCoord.xy);
    outColor = vec4(backgroundRadiance(frame, ray.direction), 1.0f);
    outNormal = vec4(0.0f);
    outMotionDepth = vec4(skyMotion(frame, gl_FragCoord.xy, ray.direction), kSkyDepth, 0.0f);
    outEntityId = kNoEntity;
}
