// SPDX-License-Identifier: MIT
// Private to engine/gltf: what every part of the glTF loader needs to see.
#pragma once

#include "engine/gltf/gltf_error.h"
#include "engine/gltf/gltf_model.h"
#include "engine/gltf/gltf_resources.h"

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

namespace shutter::gltf {

/// Sentences for LoadedScene::warnings, each kept once; past a hundred only that there are more.
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

struct GltfContext {
    const tinygltf::Model& model;
    const GltfResources& resources;
    GltfWarnings& warnings;
    /// A small file may name one buffer ten thousand times or claim accessors of zeros; this bounds
    /// what it can make us hold. Bytes left for decoded vertices, and for decoded pictures.
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
