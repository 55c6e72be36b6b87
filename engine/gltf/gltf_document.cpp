// SPDX-License-Identifier: MIT
#include "engine/gltf/gltf_document.h"

#include "engine/core/words.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>
#include <system_error>
#include <utility>

namespace shutter::gltf {

namespace {

constexpr uint32_t kMagic = 0x46546C67;     // "glTF"
constexpr uint32_t kJsonChunk = 0x4E4F534A; // "JSON"
constexpr uint32_t kBinChunk = 0x004E4942;  // "BIN\0"
constexpr size_t kHeaderBytes = 12;
constexpr size_t kChunkHeaderBytes = 8;

/// tinygltf reads `extras` and extensions with a recursive function; deeper files would overflow
/// the stack.
constexpr int kMaxNesting = 256;

constexpr std::array kSupportedExtensions = {
    std::string_view("EXT_lights_image_based"),
    std::string_view("EXT_mesh_gpu_instancing"),
    std::string_view("KHR_lights_punctual"),
    std::string_view("KHR_materials_emissive_strength"),
    std::string_view("KHR_materials_unlit"),
    std::string_view("KHR_mesh_quantization"),
    std::string_view("KHR_physics_rigid_bodies"),
    std::string_view("KHR_texture_transform"),
    std::string_view("OMI_materials_blend"),
};

uint32_t readU32(std::span<const uint8_t> bytes, size_t offset) {
    return uint32_t(bytes[offset]) | uint32_t(bytes[offset + 1]) << 8 |
           uint32_t(bytes[offset + 2]) << 16 | uint32_t(bytes[offset + 3]) << 24;
}

std::string_view asText(std::span<const uint8_t> bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

GltfChunks splitGlb(std::span<const uint8_t> bytes) {
    if (bytes.size() < kHeaderBytes)
        failGltf("the GLB header is cut off");
    const uint32_t version = readU32(bytes, 4);
    if (version != 2)
        failGltf("the GLB container has version {}, only 2 is supported", version);
    const uint32_t length = readU32(bytes, 8);
    if (length > bytes.size()) {
        failGltf(
            "the GLB header states {} but the file has {}",
            core::countOf(length, "byte"),
            bytes.size()
        );
    }
    if (length < kHeaderBytes + kChunkHeaderBytes)
        failGltf("the GLB holds no JSON chunk");

    GltfChunks chunks;
    bool hasJson = false;
    for (size_t offset = kHeaderBytes; offset < length;) {
        if (length - offset < kChunkHeaderBytes)
            failGltf("a GLB chunk header is cut off");
        const uint32_t chunkBytes = readU32(bytes, offset);
        const uint32_t type = readU32(bytes, offset + 4);
        offset += kChunkHeaderBytes;
        if (chunkBytes > length - offset)
            failGltf("a GLB chunk is longer than the file");
        const std::span<const uint8_t> data = bytes.subspan(offset, chunkBytes);
        if (!hasJson && type != kJsonChunk)
            failGltf("the GLB's first chunk is not JSON");
        if (hasJson && type == kJsonChunk)
            failGltf("the GLB has two JSON chunks");
        if (chunks.hasBin && type == kBinChunk)
            failGltf("the GLB has two BIN chunks");
        if (type == kJsonChunk) {
            chunks.json = asText(data);
            hasJson = true;
        } else if (type == kBinChunk) {
            chunks.bin = data;
            chunks.hasBin = true;
        } // other chunk types are for extensions and are skipped, as the specification requires
        offset += chunkBytes;
    }
    return chunks;
}

/// The largest number of nested objects and arrays, ignoring brackets inside strings.
int measureNesting(std::string_view text) {
    int depth = 0;
    int deepest = 0;
    bool isInString = false;
    for (size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (isInString) {
            if (c == '\\')
                ++i;
            isInString = c != '"';
        } else if (c == '"') {
            isInString = true;
        } else if (c == '{' || c == '[') {
            deepest = std::max(deepest, ++depth);
        } else if (c == '}' || c == ']') {
            --depth;
        }
    }
    return deepest;
}

/// "major.minor", digits only.
std::optional<std::pair<int, int>> parseVersion(const std::string& text) {
    std::pair<int, int> version;
    const char* end = text.data() + text.size();
    const auto major = std::from_chars(text.data(), end, version.first);
    if (major.ec != std::errc() || major.ptr == end || *major.ptr != '.')
        return std::nullopt;
    const auto minor = std::from_chars(major.ptr + 1, end, version.second);
    if (minor.ec != std::errc() || minor.ptr != end)
        return std::nullopt;
    if (version.first < 0 || version.second < 0)
        return std::nullopt;
    return version;
}

std::pair<int, int> readVersion(const nlohmann::json& asset, const char* key) {
    const nlohmann::json& value = asset.at(key);
    if (!value.is_string())
        failGltf("asset.{} is not a string", key);
    const std::string text = value.get<std::string>();
    const auto version = parseVersion(text);
    if (!version)
        failGltf("asset.{} is '{}', not of the form 2.0", key, text);
    return *version;
}

} // namespace

GltfChunks splitGltf(std::span<const uint8_t> bytes) {
    if (bytes.empty())
        failGltf("the file is empty");
    if (bytes.size() >= 4 && readU32(bytes, 0) == kMagic)
        return splitGlb(bytes);
    std::string_view text = asText(bytes);
    constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
    if (text.starts_with(kByteOrderMark))
        text.remove_prefix(kByteOrderMark.size());
    const size_t first = text.find_first_not_of(" \t\r\n");
    if (first == std::string_view::npos || (text[first] != '{' && text[first] != '[')) {
        failGltf("the content is neither glTF JSON nor a GLB container");
    }
    GltfChunks chunks;
    chunks.json = text;
    return chunks;
}

nlohmann::json parseGltfJson(std::string_view text) {
    // Some exporters pad the chunk with NUL bytes instead of spaces.
    while (!text.empty() && text.back() == '\0')
        text.remove_suffix(1);
    if (measureNesting(text) > kMaxNesting) {
        failGltf("the JSON nests deeper than {} levels", kMaxNesting);
    }
    nlohmann::json root;
    try {
        root = nlohmann::json::parse(text.begin(), text.end());
    } catch (const nlohmann::json::exception& e) {
        // The library's prefix, "[json.exception.parse_error.101] ", means nothing to a reader.
        const std::string_view why = e.what();
        const size_t prefixEnd = why.find("] ");
        failGltf(
            "the JSON does not parse: {}",
            prefixEnd == std::string_view::npos ? why : why.substr(prefixEnd + 2)
        );
    }
    if (!root.is_object())
        failGltf("the JSON's root is not an object");
    return root;
}

void checkAssetAndExtensions(const nlohmann::json& root) {
    const auto asset = root.find("asset");
    if (asset == root.end() || !asset->is_object())
        failGltf("the object 'asset' is missing");
    if (!asset->contains("version"))
        failGltf("asset.version is missing");
    const auto version = readVersion(*asset, "version");
    if (version.first != 2) {
        failGltf("asset.version is {}.{}, only glTF 2 is supported", version.first, version.second);
    }
    if (asset->contains("minVersion")) {
        const auto minVersion = readVersion(*asset, "minVersion");
        // A file that holds only `asset` cannot use any feature of a later version.
        if (minVersion > std::pair(2, 0) && root.size() > 1) {
            failGltf(
                "asset.minVersion is {}.{}, only glTF 2.0 is supported",
                minVersion.first,
                minVersion.second
            );
        }
    }
    const auto required = root.find("extensionsRequired");
    if (required == root.end())
        return;
    if (!required->is_array())
        failGltf("extensionsRequired is not an array");
    for (const nlohmann::json& name : *required) {
        if (!name.is_string())
            failGltf("extensionsRequired holds a value that is no string");
        if (!isSupportedExtension(name.get<std::string>())) {
            failGltf("the required extension {} is not supported", name.get<std::string>());
        }
    }
}

bool isSupportedExtension(std::string_view name) {
    return std::find(kSupportedExtensions.begin(), kSupportedExtensions.end(), name) !=
           kSupportedExtensions.end();
}

} // namespace shutter::gltf
