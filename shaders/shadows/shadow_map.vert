// SPDX-License-Identifier: MIT
// Casters as a light sees them.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "render/scene_bindings.glsl"
#include "shadows/shadow_shared.h"

layout(push_constant, scalar) uniform Push { ShadowDraw draw; };

layout(location = 0) out vec4 outUv;
layout(location = 1) out float outAlpha;

void main() {
    FrameRef frame = FrameRef(draw.frame);
    Geometry geometry = GeometryTable(frame.value.geometries).rows[draw.geometry];
    Vertex vertex = VertexArray(geometry.vertices).values[gl_VertexIndex];
    vec3 position = vertex.positionU0.xyz;
    uvec2 shape = draw.shapeShift < 0.0f ? geometry.openPositions : geometry.closePositions;
    if (draw.shapeShift != 0.0f && (shape.x | shape.y) != 0u)
        position =
            mix(position, PositionArray(shape).values[gl_VertexIndex].xyz, abs(draw.shapeShift));
    gl_Position = draw.clipFromObject * vec4(position, 1.0f);
    outUv = vec4(vertex.positionU0.w, vertex.normalV0.w, vertex.uv1);
    outAlpha = unpackColor(vertex.color).a;
}
