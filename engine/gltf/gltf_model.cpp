// SPDX-License-Identifier: MIT
// tinygltf's writer, unused here, needs <fstream>, which tinygltf does not include under
// TINYGLTF_NO_FS.
#include <fstream>

#define TINYGLTF_IMPLEMENTATION
#include "engine/gltf/gltf_context.h"

#include <limits>
#include <string>
#include <vector>

namespace shutter::gltf {

namespace {

/// Gives buffer view 0 to every accessor without a view, adding a view where the file has none, and
/// returns the indices of those accessors. glTF allows them (all zeros), tinygltf refuses them as
/// indices.
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
