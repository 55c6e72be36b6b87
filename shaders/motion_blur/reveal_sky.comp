// SPDX-License-Identifier: MIT
// The reveal if only a sky of one colour lies behind movers: it needs no rays.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "motion_blur/revealed_pixels.glsl"
#include "render/view_ray.glsl"

layout(local_size_x = kRevealThreads) in;

void main() {
    uint index = (gl_WorkGroupID.y * kListRow + gl_WorkGroupID.x) * kRevealThreads + gl_LocalInvocationID.x;
    if (index >= header.listedPixels) return;
    vec2 centre = vec2(pixelOf(pixels[index])) + 0.5f;
    vec2 uv = centre / vec2(params.sizePx);
    FrameRef frame = FrameRef(method.frame);
    bool sky = textureLod(uEntityId, uv, 0.0f).x == kNoEntity;
    Revealed revealed =
        sky ? keepRaster(uv)
            : revealSky(
                  frame, frame.value.background.rgb, centre, makeViewRay(frame, centre).direction
              );
    storeRevealed(pixels[index], revealed);
}
