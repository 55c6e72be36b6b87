// SPDX-License-Identifier: MIT
// Private to engine/io: reads members of extension objects, which the schema does not know.
#pragma once

#include "engine/io/gltf_model.h"
#include "engine/math/math.h"

#include <cstdint>
#include <optional>
#include <string>

namespace shutter::io {

/// The extension's object, or nullptr.
[[nodiscard]] const tinygltf::Value*
findExtension(const tinygltf::ExtensionMap& extensions, const std::string& name);

/// These return nothing for a missing member and throw GltfError, naming `path`.key, for one of the
/// wrong type or out of range.
[[nodiscard]] std::optional<double>
findNumber(const tinygltf::Value& object, const std::string& key, const std::string& path);

/// Whole number from 0 to 2^31 - 1.
[[nodiscard]] std::optional<uint32_t>
findIndex(const tinygltf::Value& object, const std::string& key, const std::string& path);

[[nodiscard]] std::optional<bool>
findBool(const tinygltf::Value& object, const std::string& key, const std::string& path);

[[nodiscard]] std::optional<math::dvec2>
findVec2(const tinygltf::Value& object, const std::string& key, const std::string& path);

[[nodiscard]] std::optional<math::dvec3>
findVec3(const tinygltf::Value& object, const std::string& key, const std::string& path);

} // namespace shutter::io
