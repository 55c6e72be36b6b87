// SPDX-License-Identifier: MIT
#include "engine/gltf/gltf_content.h"

#include "engine/gltf/gltf_document.h"
#include "engine/gltf/gltf_error.h"
#include "engine/io/content_hash.h"
#include "engine/io/file_bytes.h"
#include "engine/io/uri.h"

#include <cstdint>
#include <limits>
#include <string_view>
#include <vector>

namespace shutter::gltf {

namespace {

/// URIs of files that `root` names in one of its arrays.
void collectUris(const nlohmann::json& root, const char* array, std::vector<std::string>& uris) {
    const auto entries = root.find(array);
    if (entries == root.end() || !entries->is_array())
        return;
    for (const nlohmann::json& entry : *entries) {
        if (!entry.is_object())
            continue;
        const auto uri = entry.find("uri");
        if (uri == entry.end() || !uri->is_string())
            continue;
        std::string text = uri->get<std::string>();
        if (!io::isDataUri(text)) // embedded: in the scene's own hash
            uris.push_back(std::move(text));
    }
}

std::string hashUri(const std::filesystem::path& folder, const std::string& uri) {
    const auto file = io::resolveUri(folder, uri);
    if (!file)
        return "missing";
    const auto hash = io::computeFileHash(file.value());
    return hash ? hash.value() : "missing";
}

} // namespace

core::Result<std::string> computeSceneHash(const std::filesystem::path& path) {
    const auto bytes = io::readFileBytes(path, std::numeric_limits<uint64_t>::max());
    if (!bytes)
        return bytes.error();
    const std::vector<uint8_t>& whole = bytes.value();
    std::string hashes =
        io::computeContentHash({reinterpret_cast<const char*>(whole.data()), whole.size()});
    std::vector<std::string> uris;
    try {
        const nlohmann::json root = parseGltfJson(splitGltf(whole).json);
        collectUris(root, "buffers", uris);
        collectUris(root, "images", uris);
    } catch (const GltfError& error) {
        return core::makeError("cannot load '{}': {}", path.string(), error.what());
    }
    for (const std::string& uri : uris)
        hashes += ' ' + hashUri(path.parent_path(), uri);
    return io::computeContentHash(hashes);
}

} // namespace shutter::gltf
