// SPDX-License-Identifier: MIT
// The fragment shader of what no entity covers.
#ifndef SHUTTER_SKY_FRAGMENT_GLSL
#define SHUTTER_SKY_FRAGMENT_GLSL

#include "render/environment.glsl"
#include "render/gbuffer_targets.glsl"
#include "render/sky.glsl"
#include "render/view_ray.glsl"

layout(push_constant, scalar) uniform Push { DrawConstants draw; };

void main() {
    FrameRef frame = FrameRef(draw.frame);
    ViewRay ray = makeViewRay(frame, gl_FragCoord.xy);
    vec4 color = vec4(backgroundRadiance(frame, ray.direction), 1.0f);
    vec2 motion = skyMotion(frame, gl_FragCoord.xy, ray.direction);
    writeTargets(color, vec3(0.0f), motion, kSkyDepth, kNoEntity);
}

#endif
