// SPDX-License-Identifier: MIT
// Private to engine/gltf: typed arrays out of buffers.
#pragma once

#include "engine/gltf/gltf_context.h"

#include <string_view>
#include <vector>

namespace shutter::gltf {

/// Checks every buffer view against its buffer and every accessor against its buffer view, dense
/// and sparse part, before anything is read. Throws GltfError.
void checkAccessors(const GltfContext& context);

/// What a user of an accessor accepts; `use` names it in messages, e.g. "meshes[0].primitives[0]
/// POSITION".
struct AccessorUse {
    std::string_view use;
    std::vector<int> types;          ///< TINYGLTF_TYPE_...
    std::vector<int> componentTypes; ///< TINYGLTF_COMPONENT_TYPE_...
    /// Integer components have to be marked normalized (float components never need it).
    bool integersMustBeNormalized = false;
};

/// Components of the accessor's type: 1 to 16.
[[nodiscard]] size_t componentCount(const tinygltf::Accessor& accessor);

/// All elements as floats, interleaved; normalised integers are scaled to [0, 1] or [-1, 1], others
/// keep their value. Sparse values are put in place. May hold NaN and infinity. Throws GltfError
/// when the accessor is not what `use` accepts.
[[nodiscard]] std::vector<float>
readFloats(GltfContext& context, size_t accessor, const AccessorUse& use);

/// All elements of a scalar or vector accessor of unsigned integers, interleaved.
[[nodiscard]] std::vector<uint32_t>
readUnsigned(GltfContext& context, size_t accessor, const AccessorUse& use);

} // namespace shutter::gltf
