// SPDX-License-Identifier: MIT
// tinygltf's writer, unused here, needs <fstream> also where TINYGLTF_NO_FS keeps it from including
// it.
#include <fstream>

#define TINYGLTF_IMPLEMENTATION
#include "engine/gltf/gltf_error.h"
#include "engine/gltf/gltf_model.h"

#include <limits>
#include <string>
#include <vector>

namespace shutter::gltf {

namespace {

/// glTF allows accessors without a buffer view (all zeros), tinygltf refuses them as indices. Gives
/// each of them view 0, adding one where there is none, and returns which they were.
std::vector<size_t> giveEveryAccessorAView(nlohmann::json& root) {
    std::vector<size_t> withoutView;
    const auto accessors = root.find("accessors");
    if (accessors == root.end())
        return withoutView;
    for (size_t i = 0; i < accessors->size(); ++i) {
        nlohmann::json& accessor = (*accessors)[i];
        if (accessor.contains("bufferView"))
            continue;
        accessor["bufferView"] = 0u;
        withoutView.push_back(i);
    }
    const bool hasViews = root.contains("bufferViews") && !root["bufferViews"].empty();
    if (!withoutView.empty() && !hasViews) {
        root["bufferViews"] = {{{"buffer", 0u}, {"byteLength", 1u}}};
    }
    return withoutView;
}

} // namespace

tinygltf::Model parseGltfModel(nlohmann::json root) {
    const size_t viewCount = root.contains("bufferViews") ? root["bufferViews"].size() : 0;
    const std::vector<size_t> withoutView = giveEveryAccessorAView(root);
    const std::string text = root.dump();
    if (text.size() > std::numeric_limits<unsigned int>::max()) {
        failGltf("the JSON has {} bytes, above the limit of 4 GiB", text.size());
    }
    tinygltf::TinyGLTF parser;
    tinygltf::Model model;
    std::string error;
    std::string warning;
    if (!parser.LoadASCIIFromString(
            &model, &error, &warning, text.data(), static_cast<unsigned int>(text.size()), ""
        )) {
        while (!error.empty() && (error.back() == '\n' || error.back() == '.'))
            error.pop_back();
        failGltf("tinygltf refuses it: {}", error.empty() ? "no reason given" : error);
    }
    for (const size_t accessor : withoutView)
        model.accessors[accessor].bufferView = -1;
    model.bufferViews.resize(viewCount);
    return model;
}

} // namespace shutter::gltf
