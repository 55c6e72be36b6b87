// SPDX-License-Identifier: MIT
// The raster's depth and entity id in one image, so that a probe is one fetch; and, where the next
// frame wants it, its colour, kept as it is before the blur.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "motion_blur/resolved.glsl"
#include "render/scene_shared.h"

layout(constant_id = 0) const uint kKeepsColor = 0u;

layout(local_size_x = kGroupSize, local_size_y = kGroupSize) in;
layout(push_constant, scalar) uniform Push { MotionBlurParams params; };
layout(binding = 0) uniform sampler2D uColor;
layout(binding = 1) uniform sampler2D uMotionDepth;
layout(binding = 2) uniform usampler2D uEntityId;
layout(binding = 3, rg32f) uniform writeonly image2D uSurface; // depth, key
layout(binding = 4, rgba16f) uniform writeonly image2D uKeptColor;

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(uvec2(pixel), params.sizePx))) return;
    uint id = texelFetch(uEntityId, pixel, 0).x;
    uint key = id == kNoEntity ? kSkyKey : id;
    // A row is below 2^24, and so exact as a float.
    imageStore(
        uSurface, pixel, vec4(texelFetch(uMotionDepth, pixel, 0).z, float(key), 0.0f, 0.0f)
    );
    if (kKeepsColor != 0u) imageStore(uKeptColor, pixel, texelFetch(uColor, pixel, 0));
}
