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
    vec4 relWorldFromObject[3]; // rows of the 3x4 matrix
    float handedness;      // -1 where it mirrors, else 1
    uint firstGeometry;
    bool deforms;            // its shape changes: its vertices lie between two keys
    uint firstKey;         // the earlier of them
    float keyBlend;        // how far towards the later one, [0, 1]
};

/// Whether the table of entities has a row for the mesh id. Ids come from the host's images and
/// acceleration structures, and drivers do not check reads by address.
bool hasEntityRow(FrameRef frame, uint entity) { return entity < frame.value.entityCount; }

/// \param entity that has a row
Placement placeAtRaster(FrameRef frame, uint entity) {
    EntityTable entities = EntityTable(frame.value.entities);
    Placement placement;
    placement.relWorldFromObject = entities.rows[entity].relWorldFromObject;
    placement.handedness = entities.rows[entity].handedness;
    placement.firstGeometry = entities.rows[entity].firstGeometry;
    placement.deforms = false;
    placement.firstKey = 0u;
    placement.keyBlend = 0.0f;
    return placement;
}

vec3 transformPoint(Placement placement, vec3 p) {
    vec4 h = vec4(p, 1.0f);
    return vec3(dot(placement.relWorldFromObject[0], h), dot(placement.relWorldFromObject[1], h),
                dot(placement.relWorldFromObject[2], h));
}

vec3 transformDirection(Placement placement, vec3 d) {
    return vec3(dot(placement.relWorldFromObject[0].xyz, d), dot(placement.relWorldFromObject[1].xyz, d),
                dot(placement.relWorldFromObject[2].xyz, d));
}

/// Normals go with the cofactor matrix: right for any scale, mirrored ones included.
vec3 transformNormal(Placement placement, vec3 n) {
    vec3 x = vec3(placement.relWorldFromObject[0].x, placement.relWorldFromObject[1].x, placement.relWorldFromObject[2].x);
    vec3 y = vec3(placement.relWorldFromObject[0].y, placement.relWorldFromObject[1].y, placement.relWorldFromObject[2].y);
    vec3 z = vec3(placement.relWorldFromObject[0].z, placement.relWorldFromObject[1].z, placement.relWorldFromObject[2].z);
    return (cross(y, z) * n.x + cross(z, x) * n.y + cross(x, y) * n.z) * placement.handedness;
}

/// Where the vertex is that a ray meets.
vec3 fetchPosition(Geometry geometry, Placement placement, uint index) {
    VertexArray vertices = VertexArray(geometry.vertices);
    if (!placement.deforms) return vertices.values[index].positionU0.xyz;
    uint near = placement.firstKey * geometry.vertexCount + index;
    return mix(vertices.values[near].positionU0.xyz,
               vertices.values[near + geometry.vertexCount].positionU0.xyz, placement.keyBlend);
}

Vertex fetchVertex(Geometry geometry, Placement placement, uint index) {
    VertexArray vertices = VertexArray(geometry.vertices);
    if (!placement.deforms) return vertices.values[index];
    uint near = placement.firstKey * geometry.vertexCount + index;
    Vertex vertex = vertices.values[near];
    Vertex next = vertices.values[near + geometry.vertexCount];
    vertex.positionU0 = mix(vertex.positionU0, next.positionU0, placement.keyBlend);
    vertex.normalV0 = mix(vertex.normalV0, next.normalV0, placement.keyBlend);
    vertex.tangent = mix(vertex.tangent, next.tangent, placement.keyBlend);
    return vertex;
}

/// Where a point of a triangle is in object space at shutter open, raster instant and close.
struct PointPath {
    vec3 open;
    vec3 raster;
    vec3 close;
};

vec3 interpolatePosition(uvec2 positions, uvec3 corners, vec3 w) {
    PositionArray array = PositionArray(positions);
    return array.values[corners.x].xyz * w.x + array.values[corners.y].xyz * w.y +
           array.values[corners.z].xyz * w.z;
}

/// \param objectPosition of the point, where its shape is static
PointPath fetchPath(FrameRef frame, HitId id, vec3 objectPosition) {
    uint first = EntityTable(frame.value.entities).rows[id.entity].firstGeometry;
    Geometry geometry = GeometryTable(frame.value.geometries).rows[first + id.geometry];
    if ((geometry.openPositions.x | geometry.openPositions.y) == 0u)
        return PointPath(objectPosition, objectPosition, objectPosition);
    IndexArray indices = IndexArray(geometry.indices);
    uvec3 corners = uvec3(
        indices.values[3u * id.primitive], indices.values[3u * id.primitive + 1u],
        indices.values[3u * id.primitive + 2u]
    );
    vec3 w = vec3(1.0f - id.barycentrics.x - id.barycentrics.y, id.barycentrics);
    VertexArray vertices = VertexArray(geometry.vertices);
    PointPath path;
    path.open = interpolatePosition(geometry.openPositions, corners, w);
    path.raster = vertices.values[corners.x].positionU0.xyz * w.x +
                  vertices.values[corners.y].positionU0.xyz * w.y +
                  vertices.values[corners.z].positionU0.xyz * w.z;
    path.close = interpolatePosition(geometry.closePositions, corners, w);
    return path;
}

Hit fetchHit(FrameRef frame, Placement placement, HitId id) {
    GeometryTable geometries = GeometryTable(frame.value.geometries);
    Geometry geometry = geometries.rows[placement.firstGeometry + id.geometry];
    IndexArray indices = IndexArray(geometry.indices);
    Vertex a = fetchVertex(geometry, placement, indices.values[3u * id.primitive]);
    Vertex b = fetchVertex(geometry, placement, indices.values[3u * id.primitive + 1u]);
    Vertex c = fetchVertex(geometry, placement, indices.values[3u * id.primitive + 2u]);
    vec3 w = vec3(1.0f - id.barycentrics.x - id.barycentrics.y, id.barycentrics);

    Hit hit;
    hit.material = geometry.material;
    hit.objectPosition = a.positionU0.xyz * w.x + b.positionU0.xyz * w.y + c.positionU0.xyz * w.z;
    hit.point.relWorldPosition = transformPoint(placement, hit.objectPosition);
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
