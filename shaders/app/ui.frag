// SPDX-License-Identifier: MIT
// The user interface's colour, covered by the font atlas: glyphs, and one full texel for areas.
#version 460

layout(binding = 0) uniform sampler2D uFont;
layout(location = 0) in vec2 inUv;
layout(location = 1) in vec4 inColor;
layout(location = 0) out vec4 outColor;

void main() {
    outColor = vec4(inColor.rgb, inColor.a * textureLod(uFont, inUv, 0.0f).r);
}
