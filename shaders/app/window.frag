// SPDX-License-Identifier: MIT
// Display-encoded pictures onto the window; black around them.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "app/app_shared.h"

layout(push_constant, scalar) uniform Push { WindowParams params; };
layout(binding = 0) uniform sampler2D uLeft;
layout(binding = 1) uniform sampler2D uRight;
layout(location = 0) out vec4 outColor;

void main() {
    vec2 place = (gl_FragCoord.xy - params.originPx) / params.extentPx;
    float fromDivider = gl_FragCoord.x - params.dividerPx;
    vec3 color = vec3(0.0f);
    if (all(greaterThanEqual(place, vec2(0.0f))) && all(lessThan(place, vec2(1.0f)))) {
        if (fromDivider < 0.0f)
            color = textureLod(uLeft, place, 0.0f).rgb;
        else
            color = textureLod(uRight, place, 0.0f).rgb;
    }
    if (params.dividerPx >= 0.0f && abs(fromDivider) < params.lineHalfWidthPx)
        color = vec3(1.0f);
    outColor = vec4(color, 1.0f);
}
