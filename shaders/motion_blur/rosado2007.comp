// SPDX-License-Identifier: MIT
// The camera's part of the motion, from depth alone: Rosado 2007, "Motion Blur as a Post-Processing
// Effect", GPU Gems 3, chapter 27. A pixel's surface is taken to be static in the world.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "motion_blur/motion_blur_shared.h"
#include "render/sky.glsl"
#include "render/view_ray.glsl"

layout(local_size_x = kGroupSize, local_size_y = kGroupSize) in;
layout(push_constant, scalar) uniform Push {
    MotionBlurParams params;
    uvec2 frame; // address of the scene's FrameConstants
};
layout(binding = 0) uniform sampler2D uMotionDepth;
layout(binding = 1, rgba32f) uniform writeonly image2D uCameraMotionDepth;

/// \param depth metres along the view direction
vec2 cameraMotion(FrameRef at, ViewRay ray, float depth) {
    vec3 forward = at.value.forward.xyz;
    float beyondNear = depth - dot(ray.origin, forward);
    vec3 point = ray.origin + ray.direction * (beyondNear / dot(ray.direction, forward));
    vec4 open = at.value.clipFromRelWorldOpen * vec4(point, 1.0f);
    vec4 close = at.value.clipFromRelWorldClose * vec4(point, 1.0f);
    vec4 visible = at.value.clipFromRelWorld * vec4(point, 1.0f);
    return motionFromClip(
        open.xyw, close.xyw, visible.xyw, at.value.forward.w, at.value.sizePx
    );
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(params.sizePx)))) return;
    FrameRef at = FrameRef(frame);
    vec2 centre = vec2(pixel) + 0.5f;
    ViewRay ray = makeViewRay(at, centre);
    float depth = texelFetch(uMotionDepth, pixel, 0).z;
    vec2 motion = depth < kSkyDepth ? cameraMotion(at, ray, depth)
                                    : skyMotion(at, centre, ray.direction);
    imageStore(uCameraMotionDepth, pixel, vec4(motion, depth, 0.0f));
}
