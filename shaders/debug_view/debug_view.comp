// SPDX-License-Identifier: MIT
// An intermediate of any size over the whole picture.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "common/value_colors.glsl"
#include "debug_view/debug_view_shared.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(push_constant, scalar) uniform Push { DebugViewParams params; };
layout(binding = 0) uniform sampler2D uValues;
layout(binding = 1) uniform usampler2D uIds;
layout(binding = 2) uniform usampler2D uOtherIds;
layout(binding = 3, rgba8) uniform writeonly image2D uDisplay;

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(uvec2(pixel), params.sizePx))) return;
    vec2 uv = (vec2(pixel) + 0.5f) / vec2(params.sizePx);
    vec4 values = textureLod(uValues, uv, 0.0f);
    vec3 color = vec3(0.0f);
    if (params.kind == kShowMotion) {
        color = motionColor(values.xy, params.longestPx);
    } else if (params.kind == kShowDepth) {
        color = depthColor(values.z);
    } else if (params.kind == kShowNormal) {
        color = values.xyz * 0.5f + 0.5f;
    } else if (params.kind == kShowIds) {
        uint id = textureLod(uIds, uv, 0.0f).x;
        if (id != 0xFFFFFFFFu) color = idColor(id);
    } else if (params.kind == kShowColor) {
        color = pow(clamp(values.rgb, 0.0f, 1.0f), vec3(1.0f / 2.2f));
    } else if (params.kind == kShowMasks) {
        color = clamp(values.rgb, 0.0f, 1.0f);
    } else if (params.kind == kShowGrey) {
        color = vec3(clamp(values.x, 0.0f, 1.0f));
    } else if (params.kind == kShowHeat) {
        color = heatColor(values.x / params.heatMax);
    } else if (params.kind == kShowUnresolved) {
        // Grey inside the mask, white where the ray never came past the object in front.
        bool same = textureLod(uIds, uv, 0.0f).x == textureLod(uOtherIds, uv, 0.0f).x;
        if (values.x > 0.5f) color = vec3(same ? 1.0f : 0.25f);
    }
    imageStore(uDisplay, pixel, vec4(color, 1.0f));
}
