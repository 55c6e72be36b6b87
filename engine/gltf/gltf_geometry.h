// SPDX-License-Identifier: MIT
// Private to engine/gltf: geometry that glTF leaves to its reader (triangles of strips and fans,
// normals, tangents), as functions of plain arrays.
#pragma once

#include "engine/scene/assets.h"

#include <cstdint>
#include <span>
#include <vector>

namespace shutter::gltf {

enum class TriangleMode { List, Strip, Fan };

/// Three indices per triangle, with the winding that glTF 2.0 (3.7.2.1) defines for strips and
/// fans. Leaves out triangles that repeat an index (strips are joined by them), which have no area,
/// and trailing indices of a list that make no whole triangle.
[[nodiscard]] std::vector<uint32_t>
triangulate(std::span<const uint32_t> indices, TriangleMode mode);

/// Vertex i of the result is vertex `sources[i]` of `primitive`; indices are left empty.
[[nodiscard]] scene::Primitive
gatherVertices(const scene::Primitive& primitive, std::span<const uint32_t> sources);

/// Removes triangles with a vertex that is not finite, and all vertices that no triangle uses.
/// Returns the number of triangles removed.
size_t removeNonFiniteTriangles(scene::Primitive& primitive);

/// Gives every triangle its own vertices with its face normal, as glTF 2.0 (3.7.2.1) requires where
/// a file gives no normals. A triangle without area gets +Y.
void makeFlatNormals(scene::Primitive& primitive);

/// Normalizes every normal. One that is zero or not finite becomes the area-weighted mean of the
/// face normals around it. Returns the number of normals replaced.
size_t repairNormals(scene::Primitive& primitive);

/// Computes tangents from the texture coordinates `uv`: sums each triangle's direction of
/// increasing u at its vertices, weighted by area, and makes the sum orthogonal to the normal; w is
/// the sign of the summed bitangent. This is not MikkTSpace: vertices are not split, so a map baked
/// for MikkTSpace shades slightly differently across mirrored seams. Requires normals.
void makeTangents(scene::Primitive& primitive, const std::vector<math::vec2>& uv);

/// True when every tangent is finite and not zero.
[[nodiscard]] bool areTangentsValid(const std::vector<math::vec4>& tangents);

/// Makes tangents unit length and w +1 or -1. Requires areTangentsValid.
void normalizeTangents(std::vector<math::vec4>& tangents);

} // namespace shutter::gltf
