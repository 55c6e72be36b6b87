// SPDX-License-Identifier: MIT
// The reveal by ray queries.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "motion_blur/reveal.glsl"

layout(local_size_x = kRevealThreads) in;

void main() { revealPixel((gl_WorkGroupID.y * kListRow + gl_WorkGroupID.x) * kRevealThreads + gl_LocalInvocationID.x); }
