// SPDX-License-Identifier: MIT
// The point of a surface that a fragment shows, from the outputs of the vertex shaders of meshes.
#ifndef SHUTTER_FRAGMENT_POINT_GLSL
#define SHUTTER_FRAGMENT_POINT_GLSL

layout(location = 0) in vec3 inRelWorldPosition;
layout(location = 1) centroid in vec3 inNormal;
layout(location = 2) centroid in vec4 inTangent;
layout(location = 3) in vec4 inUv;
layout(location = 4) centroid in vec4 inColor;

// With several samples per pixel a pixel's centre may lie outside of the triangle: what is looked up
// is what is at the centroid of its coverage. Derivatives are of what is at centres, also outside:
// centroids of pixels side by side may lie on one line, or in reverse order. lavapipe (Mesa 25.0)
// interpolates at the centroid, but divides by w at the centre, which lifts points off their plane;
// a constant has the same factor.
#ifdef SHUTTER_SEVERAL_SAMPLES
layout(location = 7) centroid in float inOne;
#define SHUTTER_AT_CENTROID(value) (interpolateAtCentroid(value) / inOne)
#define SHUTTER_OF_CENTROID(value) (value / inOne)
#else
#define SHUTTER_AT_CENTROID(value) value
#define SHUTTER_OF_CENTROID(value) value
#endif

SurfacePoint pointOfFragment() {
    SurfacePoint point;
    point.relWorldPosition = SHUTTER_AT_CENTROID(inRelWorldPosition);
    vec4 uv = SHUTTER_AT_CENTROID(inUv);
    vec3 dx = dFdx(inRelWorldPosition);
    vec3 dy = dFdy(inRelWorldPosition);
    vec4 uvDx = dFdx(inUv);
    vec4 uvDy = dFdy(inUv);
    vec3 normal = cross(dx, dy);
    // The triangle's geometric normal, on the side that its winding defines as the front: for front
    // faces, the viewer's side.
    bool towardsViewer = dot(normal, point.relWorldPosition) < 0.0f;
    point.geometricNormal = towardsViewer == gl_FrontFacing ? normal : -normal;
    point.normal = inNormal;
    point.tangent = SHUTTER_OF_CENTROID(inTangent);
    point.uv[0] = uv.xy;
    point.uv[1] = uv.zw;
    point.uvDensity[0] = textureDensity(dx, dy, uvDx.xy, uvDy.xy);
    point.uvDensity[1] = textureDensity(dx, dy, uvDx.zw, uvDy.zw);
    point.color = SHUTTER_OF_CENTROID(inColor);
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
