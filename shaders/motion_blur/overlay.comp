// SPDX-License-Identifier: MIT
// Panels over a host's picture that show the motion blur's inputs, except for ids.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#include "motion_blur/motion_blur_shared.h"
#include "motion_blur/overlay.glsl"

layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer OverlayRef {
    OverlayTable value;
};

layout(local_size_x = kGroupSize, local_size_y = kGroupSize) in;
layout(push_constant, scalar) uniform Push {
    uvec2 sizePx;
    uvec2 table; // address of an OverlayTable
} params;
layout(binding = 0) uniform sampler2D uMotionDepth;
layout(binding = 1) uniform sampler2D uNormal;
layout(binding = 2, rgba16f) uniform writeonly image2D uPicture;

vec3 shownIn(OverlayTable table, uint panel, uvec2 inPanel, uvec2 shown) {
    ivec2 at = ivec2(shown);
    if (panel == kPanelNormal) return colorOfNormal(texelFetch(uNormal, at, 0).xyz);
    if (panel == kPanelJitter) {
        vec2 panelPx = vec2(params.sizePx) * 0.25f;
        return colorOfJitter(table.jitterPx, (vec2(inPanel) + 0.5f) / panelPx, panelPx);
    }
    vec4 texel = texelFetch(uMotionDepth, at, 0);
    return colorOfPanel(table, panel, vec2(shown) + 0.5f, texel.xy, texel.z);
}

void main() {
    uvec2 pixel = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(pixel, params.sizePx))) return;
    OverlayTable table = OverlayRef(params.table).value;
    uint panel = panelAt(pixel, params.sizePx);
    if (panel == kPanelCount || panel == kPanelIds || (table.panels & (1u << panel)) == 0u) return;
    uvec2 inPanel = pixel - panelOrigin(panel, params.sizePx);
    vec3 color = isInLabel(panel, inPanel, params.sizePx)
                     ? vec3(1.0f)
                     : shownIn(table, panel, inPanel, pixelInPanel(panel, pixel, params.sizePx));
    imageStore(uPicture, ivec2(pixel), vec4(color, 1.0f));
}
