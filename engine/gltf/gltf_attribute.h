// SPDX-License-Identifier: MIT
// Private to engine/gltf: vertex attributes that primitives and their morph targets share.
#pragma once

#include "engine/gltf/gltf_context.h"
#include "engine/math/math.h"

#include <string>
#include <vector>

namespace shutter::gltf {

/// Numbers of a POSITION, NORMAL or TANGENT: floats, or, where the file uses KHR_mesh_quantization,
/// small integers too. Throws GltfError, naming `path`, for other types.
/// \param type TINYGLTF_TYPE_...
[[nodiscard]] std::vector<float> readVectors(
    GltfContext& context,
    size_t accessor,
    const std::string& attribute,
    int type,
    const std::string& path
);

/// True when the file uses KHR_mesh_quantization.
[[nodiscard]] bool isQuantized(const GltfContext& context);

/// \param values as many as make whole vectors
template <class Vector>
[[nodiscard]] std::vector<Vector> toVectors(const std::vector<float>& values) {
    constexpr size_t kLength = size_t(Vector::length());
    std::vector<Vector> vectors(values.size() / kLength);
    for (size_t i = 0; i < vectors.size(); ++i) {
        for (size_t c = 0; c < kLength; ++c)
            vectors[i][glm::length_t(c)] = values[i * kLength + c];
    }
    return vectors;
}

} // namespace shutter::gltf
