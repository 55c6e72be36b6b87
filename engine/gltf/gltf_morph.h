// SPDX-License-Identifier: MIT
// Private to engine/gltf: morph targets and their weights at rest.
#pragma once

#include "engine/gltf/gltf_context.h"
#include "engine/scene/assets.h"

#include <string>
#include <vector>

namespace shutter::gltf {

/// The number of targets that every primitive of the mesh has. Throws GltfError when they differ.
[[nodiscard]] size_t countMorphTargets(const tinygltf::Mesh& mesh, const std::string& path);

/// Fills `primitive.morphTargets` from `source`, whose attributes are read but whose vertices are
/// still those of the file. Deltas of normals and tangents that the primitive does not have, and of
/// texture coordinates and colours, are left out. Throws GltfError, naming `path`.
void readMorphTargets(
    GltfContext& context,
    const tinygltf::Primitive& source,
    const std::string& path,
    scene::Primitive& primitive
);

/// `given` as it stands in a mesh or a node, or `fallback` where it is empty. Throws GltfError when
/// it does not have a number for each of the targets.
/// \param fallback one weight a target
[[nodiscard]] std::vector<float> readMorphWeights(
    const std::vector<double>& given, const std::vector<float>& fallback, const std::string& path
);

} // namespace shutter::gltf
