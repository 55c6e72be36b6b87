// SPDX-License-Identifier: MIT
// Private to engine/gltf: from bytes to a JSON tree that is safe to walk.
#pragma once

#include <nlohmann/json.hpp>

#include <cstdint>
#include <span>
#include <string_view>

namespace shutter::gltf {

/// The two parts of a glTF file. Both point into the bytes they were taken from.
struct GltfChunks {
    std::string_view json;
    std::span<const uint8_t> bin; ///< the GLB's binary chunk
    bool hasBin = false;
};

/// Tells .gltf from .glb by content and checks the container. Throws GltfError.
[[nodiscard]] GltfChunks splitGltf(std::span<const uint8_t> bytes);

/// Parses text whose objects and arrays nest at most 256 deep. Throws GltfError.
[[nodiscard]] nlohmann::json parseGltfJson(std::string_view text);

/// Checks asset.version, asset.minVersion and extensionsRequired. Throws GltfError.
void checkAssetAndExtensions(const nlohmann::json& root);

/// True for extensions that the loader reads.
[[nodiscard]] bool isSupportedExtension(std::string_view name);

} // namespace shutter::gltf
