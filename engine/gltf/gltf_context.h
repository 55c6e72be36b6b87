// SPDX-License-Identifier: MIT
// Private to engine/gltf: the shared context of the readers, in particular the model. The only file
// that includes tinygltf, so that its configuration is the same everywhere. tinygltf turns checked
// JSON into structs; it is built without file access and without image decoding, and never sees a
// buffer or an image.
#pragma once

#include "engine/gltf/extras.h"
#include "engine/gltf/gltf_document.h"
#include "engine/gltf/gltf_loader.h"
#include "engine/scene/assets.h"

#define TINYGLTF_NO_FS
#define TINYGLTF_NO_EXTERNAL_IMAGE
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_INCLUDE_STB_IMAGE
#define TINYGLTF_NO_INCLUDE_STB_IMAGE_WRITE
#define TINYGLTF_NO_INCLUDE_JSON
#include <tiny_gltf.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace shutter::gltf {

/// The model of a document that checkGltfSchema accepted, without its `buffers` and `images` (see
/// GltfResources for these). Throws GltfError.
[[nodiscard]] tinygltf::Model parseGltfModel(nlohmann::json root);

/// Collects the sentences of LoadedScene::warnings, each once. After a hundred it adds only that
/// there are more.
class GltfWarnings {
  public:
    void add(std::string sentence) {
        constexpr size_t kMaxSentences = 100;
        if (mSentences.size() > kMaxSentences)
            return;
        if (mSentences.size() == kMaxSentences)
            sentence = "there are more warnings, not listed";
        if (std::find(mSentences.begin(), mSentences.end(), sentence) == mSentences.end()) {
            mSentences.push_back(std::move(sentence));
        }
    }

    [[nodiscard]] std::vector<std::string> take() { return std::move(mSentences); }

  private:
    std::vector<std::string> mSentences;
};

/// "4 GiB", or in bytes.
[[nodiscard]] inline std::string describeBytes(uint64_t bytes) {
    constexpr uint64_t kGiB = uint64_t(1) << 30;
    const bool isRound = bytes % kGiB == 0;
    return fmt::format("{} {}", isRound ? bytes / kGiB : bytes, isRound ? "GiB" : "bytes");
}

/// What every reader of a part needs.
struct GltfContext {
    const tinygltf::Model& model;
    const GltfResources& resources;
    GltfWarnings& warnings;
    const GltfLimits& limits;
    std::span<const ExtraReader> readers;
    /// Assets::textures of the file's textures that `readers` name (loadMaterials).
    std::map<uint32_t, scene::AssetIndex> looseTextures{};
    uint64_t vertexBytes = 0; ///< spent, of limits.maxVertexBytes
    uint64_t imageBytes = 0;  ///< spent, of limits.maxImageBytes

    /// Throws GltfError when the limit of decoded vertices, skins and instances is passed.
    void spendVertexBytes(uint64_t bytes) {
        if (bytes > limits.maxVertexBytes - vertexBytes)
            failGltf("its meshes need over {} when decoded", describeBytes(limits.maxVertexBytes));
        vertexBytes += bytes;
    }

    /// The same for decoded pictures.
    void spendImageBytes(uint64_t bytes) {
        if (bytes > limits.maxImageBytes - imageBytes)
            failGltf("its textures need over {} when decoded", describeBytes(limits.maxImageBytes));
        imageBytes += bytes;
    }
};

} // namespace shutter::gltf
