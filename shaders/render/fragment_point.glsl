// SPDX-License-Identifier: MIT
// The point of a surface that a fragment shows, from the outputs of the vertex shaders of meshes.
#ifndef SHUTTER_FRAGMENT_POINT_GLSL
#define SHUTTER_FRAGMENT_POINT_GLSL

// At the centroid of the triangle's coverage of the pixel: with several samples per pixel, the
// centre may lie outside of it.
layout(location = 0) centroid in vec3 inRelWorldPosition;
layout(location = 1) centroid in vec3 inNormal;
layout(location = 2) centroid in vec4 inTangent;
layout(location = 3) centroid in vec4 inUv;
layout(location = 4) centroid in vec4 inColor;

/// The triangle's normal, on the front side as the winding defines it, from derivatives.
vec3 geometricNormal() {
    vec3 normal = cross(dFdx(inRelWorldPosition), dFdy(inRelWorldPosition));
    // Only the side matters to shading: towards the viewer for front faces.
    bool towardsViewer = dot(normal, inRelWorldPosition) < 0.0f;
    return towardsViewer == gl_FrontFacing ? normal : -normal;
}

SurfacePoint pointOfFragment() {
    SurfacePoint point;
    point.relWorldPosition = inRelWorldPosition;
    point.geometricNormal = geometricNormal();
    point.normal = inNormal;
    point.tangent = inTangent;
    point.uv[0] = inUv.xy;
    point.uv[1] = inUv.zw;
    vec3 dx = dFdx(inRelWorldPosition);
    vec3 dy = dFdy(inRelWorldPosition);
    vec4 uvDx = dFdx(inUv);
    vec4 uvDy = dFdy(inUv);
    point.uvDensity[0] = textureDensity(dx, dy, uvDx.xy, uvDy.xy);
    point.uvDensity[1] = textureDensity(dx, dy, uvDx.zw, uvDy.zw);
    point.color = inColor;
#ifdef SHUTTER_SEVERAL_SAMPLES
    point.uvPerColumn[0] = uvDx.xy;
    point.uvPerColumn[1] = uvDx.zw;
    point.uvPerRow[0] = uvDy.xy;
    point.uvPerRow[1] = uvDy.zw;
#endif
    return point;
}

MaterialRow materialOf(FrameRef frame, uint geometry) {
    uint index = GeometryTable(frame.value.geometries).rows[geometry].material;
    return MaterialTable(frame.value.materials).rows[index];
}

#endif
