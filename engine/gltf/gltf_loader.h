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
    /// One sentence for each thing that the file asks for and that is ignored or drawn differently.
    std::vector<std::string> warnings;
};

/// Reads a glTF 2.0 file, .gltf or .glb, told apart by content. Anything that cannot be drawn as
/// the file asks is an error that names the file and the field; engine/gltf/README.md lists what is
/// supported. Never opens a URI outside the file's own folder. Nothing is half-loaded.
[[nodiscard]] core::Result<LoadedScene> loadGltf(const std::filesystem::path& path);

/// A hash (engine/io/file_bytes.h) that changes whenever the scene's file changes, or a buffer or
/// image that it names. A named file that is missing changes the hash too. Error: the scene itself
/// cannot be read or is not glTF; names it.
[[nodiscard]] core::Result<std::string> computeSceneHash(const std::filesystem::path& path);

} // namespace shutter::gltf
