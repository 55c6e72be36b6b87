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
};
layout(binding = 0, scalar) readonly buffer Samples {
    SampleHeader uHeader;
    AskedSample uAsked[];
};
layout(binding = 1, scalar) writeonly buffer Answers { vec4 uAnswers[]; };
layout(binding = 2) uniform accelerationStructureEXT uScene;

void main() {
    uint index = (gl_WorkGroupID.y * 256u + gl_WorkGroupID.x) * 64u + gl_LocalInvocationIndex;
    if (index >= uHeader.listed) return;
    AskedSample asked = uAsked[index];
    vec2 centre = vec2(asked.pixel & 0xFFFFu, asked.pixel >> 16) + 0.5f;
    ShutterRay ray = makeShutterRay(FrameRef(frame), TimedRef(timed), centre, asked.time);
    DistributedSample seen =
        traceDistributed(uScene, FrameRef(frame), TimedRef(timed), ray, asked.time);
    uAnswers[index] = vec4(seen.radiance, 1.0f);
}
