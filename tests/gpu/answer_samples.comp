// SPDX-License-Identifier: MIT
// A host's rays for the samples of `adaptive`: with the engine's own tables of a scene, so that the
// picture differs from the engine's.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "motion_blur/host_samples_shared.h"
#include "render/distributed_ray.glsl"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push {
    uvec2 frame; // addresses of FrameConstants and TimedConstants
    uvec2 timed;
    float focusDistance; // metres; 0: a pinhole
};
layout(binding = 0, scalar) readonly buffer Samples {
    SampleHeader uHeader;
    RequestedSample uRequested[];
};
layout(binding = 1, scalar) writeonly buffer Answers { vec4 uAnswers[]; };
layout(binding = 2) uniform accelerationStructureEXT uScene;
layout(binding = 3, scalar) readonly buffer LensPlaces { vec2 uPlaces[]; };

/// The camera's axis that leads from the pixel to another one.
vec3 axisTo(vec2 px, vec2 otherPx, float s) {
    ShutterRay from = makeShutterRay(FrameRef(frame), TimedRef(timed), px, s);
    ShutterRay to = makeShutterRay(FrameRef(frame), TimedRef(timed), otherPx, s);
    return normalize(
        to.direction / dot(to.direction, to.forward) - from.direction / dot(from.direction, from.forward)
    );
}

/// From a place of the lens to where the pinhole's ray meets the focus plane.
void moveInLens(inout ShutterRay ray, vec2 centre, vec2 place, float s) {
    const float kFarPx = 64.0f; // for digits
    vec3 right = axisTo(centre, centre + vec2(kFarPx, 0.0f), s);
    vec3 up = axisTo(centre, centre - vec2(0.0f, kFarPx), s);
    float near = dot(ray.origin - ray.eye, ray.forward);
    vec3 focus = ray.eye + ray.direction * (focusDistance / dot(ray.direction, ray.forward));
    ray.eye += place.x * right + place.y * up;
    ray.direction = normalize(focus - ray.eye);
    ray.origin = ray.eye + ray.direction * (near / dot(ray.direction, ray.forward));
}

void main() {
    uint index = (gl_WorkGroupID.y * 256u + gl_WorkGroupID.x) * 64u + gl_LocalInvocationIndex;
    if (index >= uHeader.listed) return;
    RequestedSample sought = uRequested[index];
    vec2 centre = vec2(sought.pixel & 0xFFFFu, sought.pixel >> 16) + 0.5f;
    ShutterRay ray = makeShutterRay(FrameRef(frame), TimedRef(timed), centre, sought.time);
    if (focusDistance > 0.0f) moveInLens(ray, centre, uPlaces[index], sought.time);
    DistributedSample seen =
        traceDistributed(uScene, FrameRef(frame), TimedRef(timed), ray, sought.time);
    uAnswers[index] = vec4(seen.radiance, focusDistance > 0.0f ? seen.depth : 1.0f);
}
