// SPDX-License-Identifier: MIT
// Private to engine/gltf: the types and references of a glTF file, checked before tinygltf sees it.
#pragma once

#include <nlohmann/json.hpp>

namespace shutter::gltf {

/// Checks that every field the loader reads has its type and length, that every index is inside the
/// array it points into, and that required fields are there. Throws GltfError naming the field,
/// e.g. "meshes[0].primitives[2].indices is 500, but there are 4 accessors". Whole numbers written
/// as 3.0 become 3, because tinygltf would drop them. Unknown fields and `extras` are not looked
/// at.
void checkGltfSchema(nlohmann::json& root);

} // namespace shutter::gltf
