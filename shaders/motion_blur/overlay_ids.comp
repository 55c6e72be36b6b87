// SPDX-License-Identifier: MIT
// The panel of entity ids over a host's picture.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "motion_blur/motion_blur_shared.h"
#include "motion_blur/overlay.glsl"

layout(local_size_x = kGroupSize, local_size_y = kGroupSize) in;
layout(push_constant, scalar) uniform Push { uvec2 sizePx; } params;
layout(binding = 0) uniform usampler2D uIds;
layout(binding = 1, rgba16f) uniform writeonly image2D uPicture;

void main() {
    uvec2 pixel = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(pixel, params.sizePx))) return;
    if (panelAt(pixel, params.sizePx) != kPanelIds) return;
    uvec2 inPanel = pixel - panelOrigin(kPanelIds, params.sizePx);
    uint id = texelFetch(uIds, ivec2(pixelInPanel(kPanelIds, pixel, params.sizePx)), 0).x;
    vec3 color = isInLabel(kPanelIds, inPanel, params.sizePx) ? vec3(1.0f) : colorOfId(id);
    imageStore(uPicture, ivec2(pixel), vec4(color, 1.0f));
}
