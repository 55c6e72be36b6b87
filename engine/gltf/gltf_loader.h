// SPDX-License-Identifier: MIT
#pragma once

#include "engine/core/result.h"
#include "engine/io/uri.h"
#include "engine/scene/world.h"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace shutter::gltf {

struct LoadedScene {
    scene::World world;
    /// One sentence for each thing that the file asks for and that is ignored or drawn differently.
    std::vector<std::string> warnings;
};

/// What a file may ask of the machine.
struct GltfLimits {
    io::Reach reach = io::Reach::Folder; ///< the files that its URIs may name
    /// Bytes of decoded vertices, skins and instances, and of decoded pictures. A small file may
    /// name one buffer ten thousand times, or claim accessors that are all zeros.
    uint64_t maxVertexBytes = uint64_t(4) << 30;
    uint64_t maxImageBytes = uint64_t(4) << 30; ///< RGBA, 4 a pixel
};

/// Reads a glTF 2.0 file, .gltf or .glb, told apart by content. Anything that cannot be drawn as
/// the file asks is an error that names the file and the field; engine/gltf/README.md lists what is
/// supported. Nothing is half-loaded.
[[nodiscard]] core::Result<LoadedScene>
loadGltf(const std::filesystem::path& path, const GltfLimits& limits = {});

/// A hash (engine/io/file_bytes.h) that changes whenever the scene's file changes, or a buffer or
/// image that it names. A named file that is missing changes the hash too. Error: the scene itself
/// cannot be read or is not glTF; names it.
/// \param reach as in GltfLimits; a file beyond it is as one that is missing
[[nodiscard]] core::Result<std::string>
computeSceneHash(const std::filesystem::path& path, io::Reach reach = io::Reach::Folder);

} // namespace shutter::gltf
