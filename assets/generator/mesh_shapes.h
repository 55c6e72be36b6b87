// SPDX-License-Identifier: MIT
// Closed solids in metres, wound counter-clockwise seen from outside, smooth normals, uv0 with v
// downwards.
#pragma once

#include <glm/glm.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace shutter::generator {

struct Shape {
    std::vector<glm::vec3> positions; ///< metres, about the shape's own pivot
    std::vector<glm::vec3> normals;   ///< unit length
    std::vector<glm::vec2> uvs;
    std::vector<uint32_t> indices; ///< three per triangle

    // What of a shape deforms. Each is empty or has one element per vertex.
    std::vector<glm::u16vec4> joints; ///< of the node's skin; with weights
    std::vector<glm::vec4> weights;   ///< of the joints, their sum is 1
    std::vector<float> slack;         ///< share of waves that the vertex follows, [0, 1]
};

void addVertex(Shape& shape, glm::vec3 position, glm::vec3 normal, glm::vec2 uv);

/// A triangle of three vertices of the shape, counter-clockwise.
void addTriangle(Shape& shape, size_t a, size_t b, size_t c);

/// Adds `added`, moved by `transform` (no mirroring: it would turn the winding round). Both or
/// neither have joints and slack, unless the shape is empty.
void append(Shape& shape, const Shape& added, const glm::mat4& transform = glm::mat4(1.0f));

/// Replaces the normals by area-weighted averages over the triangles that share a vertex; a vertex
/// without a triangle keeps its own.
void smoothNormals(Shape& shape);

/// Multiplies the texture coordinates by `scale`.
[[nodiscard]] Shape withUvScale(Shape shape, glm::vec2 scale);

/// Samples a Catmull-Rom curve through `controls` (at least two) in `spanCount` equal steps.
[[nodiscard]] std::vector<glm::vec2>
smoothCurve(std::span<const glm::vec2> controls, int spanCount);

/// Turns one smooth run of (radius, height) points about +Y. Going up with the solid on the axis'
/// side faces outwards. u runs once around, v from 1 at the run's first point to 0 at its last.
/// A closed solid is several runs that share end points.
[[nodiscard]] Shape lathe(std::span<const glm::vec2> run, int segmentCount);

/// Along +Y, centred; side and both caps each take the whole texture.
[[nodiscard]] Shape cylinder(float radius, float height, int segmentCount);

/// Poles on Y.
[[nodiscard]] Shape sphere(float radius, int segmentCount, int ringCount);

/// Ring about Y. \param tubeRadius half the ring's thickness
[[nodiscard]] Shape
torus(float ringRadius, float tubeRadius, int segmentCount, int tubeSegmentCount);

/// Sharp edges; uv in tiles of `tileMetres`, centred on each face.
[[nodiscard]] Shape box(glm::vec3 halfExtents, float tileMetres);

/// Edges and corners of `radius` (below the smallest half extent), `cornerSteps` quads on each half
/// of an edge; uv along the surface in tiles of `tileMetres`.
[[nodiscard]] Shape
roundedBox(glm::vec3 halfExtents, float radius, int cornerSteps, float tileMetres);

/// A stuffed cushion in the XY plane, bulging along Z; each side takes the whole texture.
[[nodiscard]] Shape pillow(glm::vec3 halfExtents, float pinch, int gridSize);

/// A round rod along `path` (at least two points, no two neighbours alike), both ends closed.
/// \param radii metres, one per point; 0 at an end makes it a tip
[[nodiscard]] Shape
tube(std::span<const glm::vec3> path, std::span<const float> radii, int segmentCount);

/// A tube of one radius throughout.
[[nodiscard]] Shape tube(std::span<const glm::vec3> path, float radius, int segmentCount);

/// A rounded rectangle across Z, for loft().
struct LoftSection {
    float z = 0.0f;         ///< metres
    float halfWidth = 1.0f; ///< metres, about x = 0, above 0
    float bottom = 0.0f;    ///< y, metres
    float top = 1.0f;       ///< y, metres, above bottom
};

/// The solid through sections (at least two, z rising), smooth along Z, both ends flat.
/// \param roundness radius of the corners as a share of the shorter half side, (0, 1)
[[nodiscard]] Shape loft(std::span<const LoftSection> sections, float roundness);

/// Points of a helix about Y, centred. \param height metres from end to end
[[nodiscard]] std::vector<glm::vec3>
helix(float radius, float height, float turnCount, int spanCount);

/// A rectangle in the XY plane that faces +Z, centred; not a solid. uv in tiles of `tileMetres`.
[[nodiscard]] Shape sheet(glm::vec2 halfExtents, float tileMetres);

/// A sheet of `cells` quads across and up, to be bent; its slack grows from 0 at its left edge to 1
/// at its right one.
[[nodiscard]] Shape cloth(glm::vec2 halfExtents, glm::ivec2 cells, float tileMetres);

/// A spoked wheel about Z: rim, `spokeCount` thin spokes and a hub.
struct WheelSize {
    float radius = 1.0f;       ///< metres, to the middle of the rim
    float rimRadius = 0.03f;   ///< metres, half the rim's thickness
    float spokeRadius = 0.01f; ///< metres
    float hubRadius = 0.1f;    ///< metres
    int spokeCount = 16;
};

struct Wheel {
    Shape rim;
    Shape spokes;
    Shape hub;
};

[[nodiscard]] Wheel wheel(const WheelSize& size);

} // namespace shutter::generator
