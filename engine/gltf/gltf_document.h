// SPDX-License-Identifier: MIT
// Private to engine/gltf: from the bytes of a file to a checked JSON tree, and to the bytes of the
// buffers and images that it names.
#pragma once

#include "engine/io/uri.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cstdint>
#include <filesystem>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace shutter::gltf {

/// How every part of the loader reports a bad file to loadGltf. A file can be wrong in hundreds of
/// places and each of them ends the load, so this is an exception. It never leaves this folder.
/// what() is a sentence without the file's name, e.g. "accessors[3].count must be at least 1".
class GltfError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

template <class... Args>
[[noreturn]] void failGltf(fmt::format_string<Args...> format, Args&&... args) {
    throw GltfError(fmt::format(format, std::forward<Args>(args)...));
}

/// The two parts of a glTF file. Both point into the bytes they were taken from.
struct GltfChunks {
    std::string_view json;
    std::span<const uint8_t> bin; ///< the GLB's binary chunk
    bool hasBin = false;
};

/// Distinguishes .gltf from .glb by content and validates the container. Throws GltfError.
[[nodiscard]] GltfChunks splitGltf(std::span<const uint8_t> bytes);

/// Parses text whose objects and arrays nest at most 256 deep. Throws GltfError.
[[nodiscard]] nlohmann::json parseGltfJson(std::string_view text);

/// Checks asset.version, asset.minVersion and extensionsRequired. Throws GltfError.
void checkAssetAndExtensions(const nlohmann::json& root);

/// True for extensions that the loader reads.
[[nodiscard]] bool isSupportedExtension(std::string_view name);

/// Checks that every field the loader reads has its type and length, that every index is inside the
/// array it points into, and that required fields are there. Throws GltfError naming the field,
/// e.g. "meshes[0].primitives[2].indices is 500, but there are 4 accessors". Rewrites whole numbers
/// written as 3.0 to 3, because tinygltf would drop them. Ignores unknown fields and `extras`.
void checkGltfSchema(nlohmann::json& root);

/// Where a file's URIs lead.
struct GltfPlace {
    std::filesystem::path folder; ///< of the file
    io::Reach reach = io::Reach::Folder;
};

/// The bytes of buffers and images, from any location.
class GltfResources {
  public:
    /// Moves the arrays `buffers` and `images` out of `root` and reads every buffer. `bin` is the
    /// GLB's binary chunk and must outlive this object. Throws GltfError, also for buffers that are
    /// shorter than their byteLength.
    GltfResources(nlohmann::json& root, GltfPlace place, std::span<const uint8_t> bin, bool hasBin);

    /// Exactly byteLength bytes.
    [[nodiscard]] std::span<const uint8_t> buffer(size_t index) const { return mBuffers[index]; }

    [[nodiscard]] size_t imageCount() const { return mImages.size(); }

    /// "images[3] (wood.png)"
    [[nodiscard]] std::string imageLabel(size_t index) const;

    /// Index of the buffer view that holds the encoded image, or -1.
    [[nodiscard]] int imageBufferView(size_t index) const { return mImages[index].bufferView; }

    /// Encoded bytes of an image that has a URI; opens its file. Throws GltfError.
    [[nodiscard]] std::vector<uint8_t> readImageUri(size_t index) const;

  private:
    struct ImageEntry {
        std::string name;
        std::string uri;
        bool hasUri = false;
        int bufferView = -1;
    };

    void addBuffer(const nlohmann::json& json, std::span<const uint8_t> bin, bool hasBin);
    void addImage(const nlohmann::json& json);

    GltfPlace mPlace;
    std::vector<std::vector<uint8_t>> mOwned; ///< the buffers that are not the GLB's binary chunk
    std::vector<std::span<const uint8_t>> mBuffers;
    std::vector<ImageEntry> mImages;
};

} // namespace shutter::gltf
