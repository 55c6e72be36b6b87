// SPDX-License-Identifier: MIT
#include "engine/core/words.h"
#include "engine/gltf/gltf_document.h"
#include "engine/io/file_bytes.h"
#include "engine/io/uri.h"

#include <limits>
#include <utility>

namespace shutter::gltf {

namespace {

/// Far above the encoded size of any image within the size limit.
constexpr uint64_t kMaxImageBytes = uint64_t(1) << 30;

/// Reads `uri`; `label` names the field in the message.
std::vector<uint8_t> readUri(
    const GltfPlace& place, const std::string& uri, const std::string& label, uint64_t maxBytes
) {
    if (io::isDataUri(uri)) {
        core::Result<std::vector<uint8_t>> bytes = io::decodeDataUri(uri);
        if (!bytes)
            failGltf("{}: {}", label, bytes.error().message);
        return std::move(bytes).value();
    }
    const core::Result<std::filesystem::path> file = io::resolveUri(place.folder, uri, place.reach);
    if (!file)
        failGltf("{}: {}", label, file.error().message);
    core::Result<std::vector<uint8_t>> bytes = io::readFileBytes(file.value(), maxBytes);
    if (!bytes)
        failGltf("{}: {}", label, bytes.error().message);
    return std::move(bytes).value();
}

} // namespace

GltfResources::GltfResources(
    nlohmann::json& root, GltfPlace place, std::span<const uint8_t> bin, bool hasBin
)
    : mPlace(std::move(place)) {
    if (const auto buffers = root.find("buffers"); buffers != root.end()) {
        for (const nlohmann::json& buffer : *buffers)
            addBuffer(buffer, bin, hasBin);
        root.erase("buffers");
    }
    if (const auto images = root.find("images"); images != root.end()) {
        for (const nlohmann::json& image : *images)
            addImage(image);
        root.erase("images");
    }
}

void GltfResources::addBuffer(
    const nlohmann::json& json, std::span<const uint8_t> bin, bool hasBin
) {
    const size_t index = mBuffers.size();
    const auto byteLength = json.at("byteLength").get<uint64_t>();
    const auto uri = json.find("uri");
    std::span<const uint8_t> bytes;
    if (uri != json.end()) {
        const std::string label = fmt::format("buffers[{}].uri", index);
        mOwned.push_back(readUri(mPlace, uri->get<std::string>(), label, byteLength));
        bytes = mOwned.back();
    } else if (index == 0 && hasBin) {
        bytes = bin;
    } else {
        failGltf("buffers[{}] has no uri and there is no binary chunk for it", index);
    }
    if (bytes.size() < byteLength) {
        failGltf(
            "buffers[{}].byteLength is {}, but {}",
            index,
            byteLength,
            core::thereAre(bytes.size(), "byte")
        );
    }
    mBuffers.push_back(bytes.first(byteLength));
}

void GltfResources::addImage(const nlohmann::json& json) {
    ImageEntry entry;
    entry.name = json.value("name", std::string());
    if (const auto uri = json.find("uri"); uri != json.end()) {
        entry.uri = uri->get<std::string>();
        entry.hasUri = true;
    }
    if (const auto view = json.find("bufferView"); view != json.end()) {
        entry.bufferView = view->get<int>();
    }
    if (entry.hasUri && entry.bufferView >= 0) {
        failGltf("images[{}] has both a uri and a bufferView", mImages.size());
    }
    mImages.push_back(std::move(entry));
}

std::string GltfResources::imageLabel(size_t index) const {
    const ImageEntry& entry = mImages[index];
    std::string name = entry.name;
    if (entry.hasUri && !io::isDataUri(entry.uri))
        name = io::abbreviateUri(entry.uri);
    return name.empty() ? fmt::format("images[{}]", index)
                        : fmt::format("images[{}] ({})", index, name);
}

std::vector<uint8_t> GltfResources::readImageUri(size_t index) const {
    const ImageEntry& entry = mImages[index];
    if (!entry.hasUri)
        failGltf("images[{}] has neither a uri nor a bufferView", index);
    return readUri(mPlace, entry.uri, fmt::format("images[{}].uri", index), kMaxImageBytes);
}

} // namespace shutter::gltf
