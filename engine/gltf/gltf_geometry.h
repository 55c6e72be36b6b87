// SPDX-License-Identifier: MIT
// Private to engine/gltf: what glTF leaves to the reader of a primitive, as functions of plain
// arrays.
#pragma once

#include "engine/scene/assets.h"

#include <cstdint>
#include <span>
#include <vector>

namespace shutter::gltf {

enum class TriangleMode { List, Strip, Fan };

/// Three indices a triangle, wound as glTF 2.0 (3.7.2.1) defines for strips and fans. Triangles
/// with an index twice (how strips are joined) have no surface and are left out. Indices of a list
/// that make no whole triangle are ignored.
[[nodiscard]] std::vector<uint32_t>
triangulate(std::span<const uint32_t> indices, TriangleMode mode);

/// Vertex i of the result is vertex `sources[i]` of `primitive`; indices are left empty.
[[nodiscard]] scene::Primitive
gatherVertices(const scene::Primitive& primitive, std::span<const uint32_t> sources);

/// Removes triangles with a vertex that is not finite and all vertices that no triangle uses.
/// Returns the number of triangles removed.
size_t removeNonFiniteTriangles(scene::Primitive& primitive);

/// Gives every triangle vertices of its own and its face normal (glTF 2.0, 3.7.2.1: flat normals
/// where none are given). A triangle without area gets +Y.
void makeFlatNormals(scene::Primitive& primitive);

/// Makes every normal unit length. One that is zero or not finite becomes the mean of its
/// triangles' face normals, weighted by area. Returns how many there were.
size_t repairNormals(scene::Primitive& primitive);

/// Tangents from the texture coordinates `uv`: each triangle's direction of growing u, summed at
/// its vertices weighted by area, made orthogonal to the normal; w is the sign of the summed
/// bitangent. This is not MikkTSpace: vertices are not split, so a map baked for MikkTSpace shades
/// slightly differently across mirrored seams. Needs normals.
void makeTangents(scene::Primitive& primitive, const std::vector<math::vec2>& uv);

/// True when tangents read from a file can be used: finite, not zero.
[[nodiscard]] bool areTangentsValid(const std::vector<math::vec4>& tangents);

/// Unit length, w = +1 or -1. Needs areTangentsValid.
void normalizeTangents(std::vector<math::vec4>& tangents);

} // namespace shutter::gltf
