// SPDX-License-Identifier: MIT
#pragma once

#include "engine/core/result.h"
#include "engine/gltf/extras.h"
#include "engine/io/uri.h"
#include "engine/scene/world.h"

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace shutter::gltf {

struct LoadedScene {
    scene::World world;
    /// One sentence for each feature of the file that is ignored or drawn differently.
    std::vector<std::string> warnings;
};

/// Limits on the resources that a file may use.
struct GltfLimits {
    io::Reach reach = io::Reach::Folder; ///< the files that its URIs may name
    /// Bytes of decoded vertices, skins and instances, and of decoded pictures. A small file may
    /// name one buffer ten thousand times, or claim accessors that are all zeros.
    uint64_t maxVertexBytes = uint64_t(4) << 30;
    uint64_t maxImageBytes = uint64_t(4) << 30; ///< RGBA, 4 a pixel
};

/// Reads a glTF 2.0 file, .gltf or .glb, distinguished by content. Error: names the file and the
/// field that is not supported; engine/gltf/README.md lists the supported features. No partial
/// results.
/// \param readers of `extras` that this folder does not know
[[nodiscard]] core::Result<LoadedScene> loadGltf(
    const std::filesystem::path& path,
    const GltfLimits& limits = {},
    std::span<const ExtraReader> readers = {}
);

/// A hash (engine/io/file_bytes.h) that changes whenever the scene's file changes, or a buffer or
/// image that it names. A named file that is missing changes the hash too. Error: the scene itself
/// cannot be read or is not glTF; names it.
/// \param reach as in GltfLimits; a file beyond it is as one that is missing
[[nodiscard]] core::Result<std::string>
computeSceneHash(const std::filesystem::path& path, io::Reach reach = io::Reach::Folder);

} // namespace shutter::gltf
