// SPDX-License-Identifier: MIT
// A triangle by its ids, and the point of it that a ray hit. One source of what happens at a hit,
// whatever traced the ray.
#ifndef SHUTTER_HIT_GLSL
#define SHUTTER_HIT_GLSL

#include "render/surface.glsl"

struct HitId {
    uint entity;
    uint geometry;  // index within the entity's mesh
    uint primitive;
    vec2 barycentrics; // of the second and third vertex
};

struct Hit {
    SurfacePoint point;
    vec3 objectPosition;
    uint material;
};

/// Where an entity is at one instant, and which triangles it has.
struct Placement {
    vec4 eyeFromObject[3]; // rows of the 3x4 matrix
    float handedness;      // -1 where it mirrors, else 1
    uint firstGeometry;
};

Placement placeAtRaster(FrameRef frame, uint entity) {
    EntityTable entities = EntityTable(frame.value.entities);
    Placement placement;
    placement.eyeFromObject = entities.rows[entity].eyeFromObject;
    placement.handedness = entities.rows[entity].handedness;
    placement.firstGeometry = entities.rows[entity].firstGeometry;
    return placement;
}

vec3 transformPoint(Placement placement, vec3 p) {
    vec4 h = vec4(p, 1.0f);
    return vec3(dot(placement.eyeFromObject[0], h), dot(placement.eyeFromObject[1], h),
                dot(placement.eyeFromObject[2], h));
}

vec3 transformDirection(Placement placement, vec3 d) {
    return vec3(dot(placement.eyeFromObject[0].xyz, d), dot(placement.eyeFromObject[1].xyz, d),
                dot(placement.eyeFromObject[2].xyz, d));
}

/// Normals go with the cofactor matrix: right for any scale, mirrored ones included.
vec3 transformNormal(Placement placement, vec3 n) {
    vec3 x = vec3(placement.eyeFromObject[0].x, placement.eyeFromObject[1].x, placement.eyeFromObject[2].x);
    vec3 y = vec3(placement.eyeFromObject[0].y, placement.eyeFromObject[1].y, placement.eyeFromObject[2].y);
    vec3 z = vec3(placement.eyeFromObject[0].z, placement.eyeFromObject[1].z, placement.eyeFromObject[2].z);
    return (cross(y, z) * n.x + cross(z, x) * n.y + cross(x, y) * n.z) * placement.handedness;
}

Hit fetchHit(FrameRef frame, Placement placement, HitId id) {
    GeometryTable geometries = GeometryTable(frame.value.geometries);
    Geometry geometry = geometries.rows[placement.firstGeometry + id.geometry];
    IndexArray indices = IndexArray(geometry.indices);
    VertexArray vertices = VertexArray(geometry.vertices);
    Vertex a = vertices.values[indices.values[3u * id.primitive]];
    Vertex b = vertices.values[indices.values[3u * id.primitive + 1u]];
    Vertex c = vertices.values[indices.values[3u * id.primitive + 2u]];
    vec3 w = vec3(1.0f - id.barycentrics.x - id.barycentrics.y, id.barycentrics);

    Hit hit;
    hit.material = geometry.material;
    hit.objectPosition = a.positionU0.xyz * w.x + b.positionU0.xyz * w.y + c.positionU0.xyz * w.z;
    hit.point.eyePosition = transformPoint(placement, hit.objectPosition);
    vec3 objectEdge1 = b.positionU0.xyz - a.positionU0.xyz;
    vec3 objectEdge2 = c.positionU0.xyz - a.positionU0.xyz;
    vec3 edge1 = transformDirection(placement, objectEdge1);
    vec3 edge2 = transformDirection(placement, objectEdge2);
    hit.point.geometricNormal = transformNormal(placement, cross(objectEdge1, objectEdge2));
    hit.point.normal =
        transformNormal(placement, a.normalV0.xyz * w.x + b.normalV0.xyz * w.y + c.normalV0.xyz * w.z);
    vec4 tangent = a.tangent * w.x + b.tangent * w.y + c.tangent * w.z;
    hit.point.tangent = vec4(transformDirection(placement, tangent.xyz), tangent.w * placement.handedness);
    vec2 uvA = vec2(a.positionU0.w, a.normalV0.w);
    vec2 uvB = vec2(b.positionU0.w, b.normalV0.w);
    vec2 uvC = vec2(c.positionU0.w, c.normalV0.w);
    hit.point.uv[0] = uvA * w.x + uvB * w.y + uvC * w.z;
    hit.point.uv[1] = a.uv1 * w.x + b.uv1 * w.y + c.uv1 * w.z;
    hit.point.uvDensity[0] = textureDensity(edge1, edge2, uvB - uvA, uvC - uvA);
    hit.point.uvDensity[1] = textureDensity(edge1, edge2, b.uv1 - a.uv1, c.uv1 - a.uv1);
    hit.point.color = unpackColor(a.color) * w.x + unpackColor(b.color) * w.y +
                      unpackColor(c.color) * w.z;
    return hit;
}

#endif
