// SPDX-License-Identifier: MIT
#version 460

layout(location = 0) in vec4 inColor; // as it is displayed: the target is in gamma space
layout(location = 0) out vec4 outColor;

void main() { outColor = inColor; }
