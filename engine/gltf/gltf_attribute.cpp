// SPDX-License-Identifier: MIT
#include "engine/gltf/gltf_attribute.h"

#include "engine/gltf/gltf_accessor.h"

#include <algorithm>

namespace shutter::gltf {

namespace {

constexpr int kByte = TINYGLTF_COMPONENT_TYPE_BYTE;
constexpr int kUnsignedByte = TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE;
constexpr int kShort = TINYGLTF_COMPONENT_TYPE_SHORT;
constexpr int kUnsignedShort = TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT;
constexpr int kFloat = TINYGLTF_COMPONENT_TYPE_FLOAT;

} // namespace

bool isQuantized(const GltfContext& context) {
    const std::vector<std::string>& used = context.model.extensionsUsed;
    return std::find(used.begin(), used.end(), "KHR_mesh_quantization") != used.end();
}

std::vector<float> readVectors(
    GltfContext& context,
    size_t accessor,
    const std::string& attribute,
    int type,
    const std::string& path
) {
    if (!isQuantized(context))
        return readFloats(context, accessor, {path, {type}, {kFloat}});
    if (attribute == "POSITION") {
        return readFloats(
            context,
            accessor,
            {path, {type}, {kFloat, kByte, kUnsignedByte, kShort, kUnsignedShort}}
        );
    }
    return readFloats(context, accessor, {path, {type}, {kFloat, kByte, kShort}, true});
}

} // namespace shutter::gltf
