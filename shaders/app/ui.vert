// SPDX-License-Identifier: MIT
// Triangles of the user interface, corners pulled by address.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#extension GL_EXT_scalar_block_layout : require
#include "app/app_shared.h"

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer UiVertices {
    UiVertex values[];
};

layout(push_constant, scalar) uniform Push { UiParams params; };

layout(location = 0) out vec2 outUv;
layout(location = 1) out vec4 outColor;

void main() {
    UiVertex vertex = UiVertices(params.vertices).values[gl_VertexIndex];
    gl_Position = vec4(vertex.positionPx * params.clipPerPixel - 1.0f, 0.0f, 1.0f);
    outUv = vertex.uv;
    outColor = unpackUnorm4x8(vertex.color);
}
