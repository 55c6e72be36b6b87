// SPDX-License-Identifier: MIT
// Private to engine/gltf: the bytes of buffers and images, wherever the file keeps them.
#pragma once

#include <nlohmann/json.hpp>

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace shutter::gltf {

class GltfResources {
  public:
    /// Takes the arrays `buffers` and `images` out of `root` and reads every buffer. `bin` is the
    /// GLB's binary chunk and has to outlive this object. Throws GltfError, also for buffers that
    /// are shorter than their byteLength.
    GltfResources(
        nlohmann::json& root,
        std::filesystem::path folder,
        std::span<const uint8_t> bin,
        bool hasBin
    );

    [[nodiscard]] size_t bufferCount() const { return mBuffers.size(); }

    /// Exactly byteLength bytes.
    [[nodiscard]] std::span<const uint8_t> buffer(size_t index) const { return mBuffers[index]; }

    [[nodiscard]] size_t imageCount() const { return mImages.size(); }

    /// "images[3] (wood.png)"
    [[nodiscard]] std::string imageLabel(size_t index) const;

    /// Index of the buffer view that holds the encoded picture, or -1.
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

    std::filesystem::path mFolder;
    std::vector<std::vector<uint8_t>> mOwned; ///< one a buffer that is not the GLB's chunk
    std::vector<std::span<const uint8_t>> mBuffers;
    std::vector<ImageEntry> mImages;
};

} // namespace shutter::gltf
