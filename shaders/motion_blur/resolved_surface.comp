// SPDX-License-Identifier: MIT
// The raster's depth and entity id in one image, so that a probe is one fetch.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "motion_blur/resolved.glsl"
#include "render/scene_shared.h"

layout(local_size_x = kGroupSize, local_size_y = kGroupSize) in;
layout(push_constant, scalar) uniform Push { MotionBlurParams params; };
layout(binding = 0) uniform sampler2D uMotionDepth;
layout(binding = 1) uniform usampler2D uEntityId;
layout(binding = 2, rg32f) uniform writeonly image2D uSurface; // depth, key

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(uvec2(pixel), params.sizePx))) return;
    vec2 uv = (vec2(pixel) + 0.5f) / vec2(params.sizePx); // texelFetch is slow on software devices
    uint id = textureLod(uEntityId, uv, 0.0f).x;
    uint key = id == kNoEntity ? kSkyKey : id;
    // A row is below 2^24, and so exact as a float.
    imageStore(
        uSurface, pixel, vec4(textureLod(uMotionDepth, uv, 0.0f).z, float(key), 0.0f, 0.0f)
    );
}
