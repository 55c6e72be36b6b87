// SPDX-License-Identifier: MIT
// Private to engine/gltf: what the readers of the parts see, above all the model. The one place
// that includes tinygltf, so that every source file sees it configured alike. tinygltf turns
// checked JSON into structs; it is built without file access and without image decoding, and never
// sees a buffer or an image.
#pragma once

#include "engine/gltf/gltf_document.h"

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

/// What every reader of a part needs.
struct GltfContext {
    const tinygltf::Model& model;
    const GltfResources& resources;
    GltfWarnings& warnings;
    /// Bytes left for decoded vertices, skins and instances, and for decoded images. A small file
    /// may name one buffer ten thousand times, or claim accessors that are all zeros; these budgets
    /// bound the memory that it can make the loader allocate.
    uint64_t vertexBytesLeft = uint64_t(4) << 30;
    uint64_t imageBytesLeft = uint64_t(4) << 30;

    /// Throws GltfError when the budget for decoded vertices is spent.
    void spendVertexBytes(uint64_t bytes) {
        if (bytes > vertexBytesLeft)
            failGltf("its meshes need over 4 GiB when decoded");
        vertexBytesLeft -= bytes;
    }
};

} // namespace shutter::gltf
