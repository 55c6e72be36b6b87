// SPDX-License-Identifier: MIT
// A blended surface where it is at an instant of the exposure.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "glass/blended_layer_shared.h"
#include "render/hit.glsl"

layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer LayerPlaceRef {
    LayerPlace value;
};
layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer LayerInstantRef {
    LayerInstant value;
};
layout(push_constant, scalar) uniform Push { LayerDraw draw; };

layout(location = 0) out vec3 outRelWorldPosition;
layout(location = 1) out vec3 outNormal;
layout(location = 2) out vec4 outTangent;
layout(location = 3) out vec4 outUv;
layout(location = 4) out vec4 outColor;

/// Straight from shutter open to close where the shape changes, as motion vectors have it.
vec3 positionAt(Geometry geometry, Vertex vertex, float time) {
    if ((geometry.openPositions.x | geometry.openPositions.y) == 0u) return vertex.positionU0.xyz;
    vec3 open = PositionArray(geometry.openPositions).values[gl_VertexIndex].xyz;
    vec3 close = PositionArray(geometry.closePositions).values[gl_VertexIndex].xyz;
    return mix(open, close, time);
}

void main() {
    FrameRef frame = FrameRef(draw.frame);
    Geometry geometry = GeometryTable(frame.value.geometries).rows[draw.geometry];
    Vertex vertex = VertexArray(geometry.vertices).values[gl_VertexIndex];
    LayerPlace place = LayerPlaceRef(draw.place).value;
    float time = LayerInstantRef(draw.instant).value.time;
    vec3 position = positionAt(geometry, vertex, time);
    gl_Position = place.clipFromObject * vec4(position, 1.0f);
    Placement placement = placeAtRaster(frame, draw.entity);
    placement.relWorldFromObject = place.relWorldFromObject;
    outRelWorldPosition = transformPoint(placement, position);
    outNormal = transformNormal(placement, vertex.normalV0.xyz);
    outTangent = vec4(
        transformDirection(placement, vertex.tangent.xyz), vertex.tangent.w * placement.handedness
    );
    outUv = vec4(vertex.positionU0.w, vertex.normalV0.w, vertex.uv1);
    outColor = unpackColor(vertex.color);
}
