// SPDX-License-Identifier: MIT
#pragma once

#include "engine/core/result.h"
#include "engine/scene/world.h"

#include <filesystem>
#include <string>
#include <vector>

namespace shutter::gltf {

struct LoadedScene {
    scene::World world;
    std::vector<std::string> warnings; ///< what the file asks for and is not drawn, a sentence each
};

/// Reads a glTF 2.0 file (.gltf or .glb, told by content). Refuses, with a sentence that names the
/// file and the field, anything that cannot be drawn as asked; see engine/gltf/README.md for what
/// is supported. Never opens a URI outside the file's own folder. Nothing is half-loaded.
[[nodiscard]] core::Result<LoadedScene> loadGltf(const std::filesystem::path& path);

} // namespace shutter::gltf
