// SPDX-License-Identifier: MIT
#include "engine/io/gltf_skin.h"

#include "engine/io/gltf_accessor.h"

#include <algorithm>
#include <map>
#include <optional>

namespace shutter::io {

namespace {

/// The largest joint number that a primitive's vertices name, or nothing without JOINTS_0.
std::optional<uint32_t>
findLargestJoint(GltfContext& context, const tinygltf::Primitive& primitive, std::string path) {
    const auto joints = primitive.attributes.find("JOINTS_0");
    const auto weights = primitive.attributes.find("WEIGHTS_0");
    if (joints == primitive.attributes.end() || weights == primitive.attributes.end()) {
        return std::nullopt;
    }
    const auto index = size_t(joints->second);
    const size_t jointCount = context.model.accessors[index].count;
    const size_t weightCount = context.model.accessors[size_t(weights->second)].count;
    if (jointCount != weightCount) {
        failGltf("{} has {} JOINTS_0 but {} WEIGHTS_0", path, jointCount, weightCount);
    }
    path += " JOINTS_0";
    const std::vector<uint32_t> values = readUnsigned(
        context,
        index,
        {path,
         {TINYGLTF_TYPE_VEC4},
         {TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE, TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT}}
    );
    return *std::max_element(values.begin(), values.end());
}

} // namespace

void checkSkinnedNodes(GltfContext& context) {
    const tinygltf::Model& model = context.model;
    // Many nodes may share one mesh; its vertices are read once.
    std::map<int, uint32_t> largestOfMesh;
    for (size_t n = 0; n < model.nodes.size(); ++n) {
        const tinygltf::Node& node = model.nodes[n];
        if (node.skin < 0)
            continue;
        context.warnings.add("skins are not deformed yet: drawn in the bind pose");
        if (node.mesh < 0)
            continue;
        const auto [entry, isNew] = largestOfMesh.try_emplace(node.mesh, 0u);
        const std::vector<tinygltf::Primitive>& primitives =
            model.meshes[size_t(node.mesh)].primitives;
        for (size_t p = 0; isNew && p < primitives.size(); ++p) {
            const std::string path = fmt::format("meshes[{}].primitives[{}]", node.mesh, p);
            const uint32_t largest = findLargestJoint(context, primitives[p], path).value_or(0);
            entry->second = std::max(entry->second, largest);
        }
        const size_t jointCount = model.skins[size_t(node.skin)].joints.size();
        if (entry->second > 0 && entry->second >= jointCount) {
            failGltf(
                "nodes[{}]: meshes[{}] names joint {}, but skins[{}] has {} joints",
                n,
                node.mesh,
                entry->second,
                node.skin,
                jointCount
            );
        }
    }
}

} // namespace shutter::io
