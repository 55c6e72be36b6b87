// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
#include "render/hit.glsl"

layout(constant_id = 2) const uint kMoves = 1u; // 0: the entity has no motion

layout(push_constant, scalar) uniform Push { DrawConstants draw; };

layout(location = 0) out vec3 outRelWorldPosition;
layout(location = 1) out vec3 outNormal;
layout(location = 2) out vec4 outTangent;
layout(location = 3) out vec4 outUv;
layout(location = 4) out vec4 outColor;
layout(location = 5) out vec3 outClipOpen;  // x, y, w
layout(location = 6) out vec3 outClipClose; // x, y, w
layout(location = 7) out float outOne;      // see pointOfFragment()

void main() {
    FrameRef frame = FrameRef(draw.frame);
    EntityRow row = EntityTable(frame.value.entities).rows[draw.entity];
    Geometry geometry = GeometryTable(frame.value.geometries).rows[draw.geometry];
    Vertex vertex = VertexArray(geometry.vertices).values[gl_VertexIndex];

    vec4 position = vec4(vertex.positionU0.xyz, 1.0f);
    gl_Position = row.clipFromObjectRaster * position;
    outClipOpen = vec3(0.0f);
    outClipClose = vec3(0.0f);
    if (kMoves != 0u) {
        vec4 positionOpen = position;
        vec4 positionClose = position;
        if ((geometry.openPositions.x | geometry.openPositions.y) != 0u) {
            positionOpen = PositionArray(geometry.openPositions).values[gl_VertexIndex];
            positionClose = PositionArray(geometry.closePositions).values[gl_VertexIndex];
        }
        EntityMotion motion = MotionTable(frame.value.entityMotions).rows[row.motion];
        outClipOpen = (motion.clipFromObjectOpen * positionOpen).xyw;
        outClipClose = (motion.clipFromObjectClose * positionClose).xyw;
    }
    Placement placement = placeAtRaster(frame, draw.entity);
    outRelWorldPosition = transformPoint(placement, position.xyz);
    outNormal = transformNormal(placement, vertex.normalV0.xyz);
    outTangent = vec4(
        transformDirection(placement, vertex.tangent.xyz), vertex.tangent.w * placement.handedness
    );
    outUv = vec4(vertex.positionU0.w, vertex.normalV0.w, vertex.uv1);
    outOne = 1.0f;
    outColor = unpackColor(vertex.color);
}
