// SPDX-License-Identifier: MIT
#pragma once

#include "engine/core/result.h"

#include <filesystem>
#include <string>

namespace shutter::gltf {

/// Changes whenever the scene's file does, or a buffer or picture beside it that it names
/// (content_hash.h). A file that is named and missing counts as such. Error: the scene itself is no
/// glTF; names it.
[[nodiscard]] core::Result<std::string> computeSceneHash(const std::filesystem::path& path);

} // namespace shutter::gltf
