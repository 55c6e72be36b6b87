// SPDX-License-Identifier: MIT
#include "engine/gltf/gltf_loader.h"

#include "engine/gltf/gltf_parts.h"
#include "engine/gltf/gltf_values.h"
#include "engine/io/file_bytes.h"
#include "engine/io/uri.h"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <exception>
#include <limits>
#include <new>
#include <string_view>
#include <utility>

namespace shutter::gltf {

namespace {

/// The length field of a GLB allows no more, and no sensible .gltf with embedded data has more.
constexpr uint64_t kMaxFileBytes = uint64_t(4) << 30;

void warnIgnoredExtensions(GltfContext& context) {
    for (const std::string& name : context.model.extensionsUsed) {
        if (!isSupportedExtension(name)) {
            context.warnings.add(fmt::format("the extension {} is ignored", name));
        }
    }
}

/// An object in `extras` that this engine reads.
struct OwnExtra {
    std::string_view name;
    std::string_view parent;
};

constexpr OwnExtra kOwnExtras[] = {
    {"lens", "camera"}, {"motionBlur", "node"}, {"vertexWaves", "node"}};

bool areEqualExceptForCase(std::string_view a, std::string_view b) {
    return std::equal(
        a.begin(),
        a.end(),
        b.begin(),
        b.end(),
        [](unsigned char left, unsigned char right) {
            return std::tolower(left) == std::tolower(right);
        }
    );
}

/// Warns of objects whose name differs from one of ours in case alone, or that are in the extras of
/// a part where they have no effect: likely a mistake. Other programs' extras cause no warning.
void warnOfMisplacedExtras(
    GltfContext& context,
    const tinygltf::Value& extras,
    std::string_view parent,
    const std::string& path
) {
    if (!extras.IsObject())
        return;
    std::vector<OwnExtra> all(std::begin(kOwnExtras), std::end(kOwnExtras));
    for (const ExtraReader& reader : context.readers)
        all.push_back({reader.name, "node"});
    for (const std::string& key : extras.Keys())
        for (const OwnExtra& own : all)
            if (areEqualExceptForCase(key, own.name) && (key != own.name || parent != own.parent) &&
                extras.Get(key).IsObject())
                context.warnings.add(fmt::format(
                    "{}.extras.{} is not used: it is '{}' in the extras of a {}",
                    path,
                    key,
                    own.name,
                    own.parent
                ));
}

void warnOfMisplacedExtras(GltfContext& context) {
    const auto warn = [&](const auto& parts, std::string_view parent, const char* array) {
        for (size_t i = 0; i < parts.size(); ++i)
            warnOfMisplacedExtras(
                context, parts[i].extras, parent, fmt::format("{}[{}]", array, i)
            );
    };
    warn(context.model.cameras, "camera", "cameras");
    warn(context.model.nodes, "node", "nodes");
    warn(context.model.scenes, "scene", "scenes");
}

/// Throws GltfError and whatever the libraries throw.
LoadedScene buildScene(
    const std::filesystem::path& folder,
    std::span<const uint8_t> bytes,
    const GltfLimits& limits,
    std::span<const ExtraReader> readers
) {
    const GltfChunks chunks = splitGltf(bytes);
    nlohmann::json root = parseGltfJson(chunks.json);
    checkAssetAndExtensions(root);
    checkGltfSchema(root);
    const GltfResources resources(root, {folder, limits.reach}, chunks.bin, chunks.hasBin);
    const tinygltf::Model model = parseGltfModel(std::move(root));

    LoadedScene loaded;
    GltfWarnings warnings;
    GltfContext context{model, resources, warnings, limits, readers};
    checkAccessors(context);
    warnIgnoredExtensions(context);
    warnOfMisplacedExtras(context);
    loadMaterials(context, loaded.world.assets);
    loadEnvironment(context, loaded.world.assets);
    loadMeshes(context, loaded.world.assets);
    loadSkins(context, loaded.world.assets);
    bindMeshes(context, loaded.world.assets);
    const std::vector<ecs::Entity> entities = loadNodes(context, loaded.world);
    addSkins(context, loaded.world, entities);
    addAutoFocus(context, loaded.world, entities);
    loadAnimations(context, loaded.world, entities);
    expandInstances(context, loaded.world, entities);
    loaded.warnings = warnings.take();
    return loaded;
}

/// Appends the URIs of files that the given array of `root` names.
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
        if (!io::isDataUri(text)) // embedded data is part of the scene's own hash
            uris.push_back(std::move(text));
    }
}

std::string hashUri(const std::filesystem::path& folder, const std::string& uri, io::Reach reach) {
    const auto file = io::resolveUri(folder, uri, reach);
    if (!file)
        return "missing";
    const auto hash = io::computeFileHash(file.value());
    return hash ? hash.value() : "missing";
}

} // namespace

core::Result<LoadedScene> loadGltf(
    const std::filesystem::path& path,
    const GltfLimits& limits,
    std::span<const ExtraReader> readers
) try {
    core::Result<std::vector<uint8_t>> bytes = io::readFileBytes(path, kMaxFileBytes);
    if (!bytes)
        return bytes.error();
    try {
        return buildScene(path.parent_path(), bytes.value(), limits, readers);
    } catch (const GltfError& e) {
        return core::makeError("cannot load '{}': {}", path.string(), e.what());
    } catch (const std::bad_alloc&) {
        return core::makeError("cannot load '{}': out of memory", path.string());
    }

} catch (const std::exception& e) {

    // Unforeseen exceptions of tinygltf, the JSON parser or the file system.
    return core::makeError("cannot load '{}': {}", path.string(), e.what());
}

core::Result<std::string> computeSceneHash(const std::filesystem::path& path, io::Reach reach) {
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
        hashes += ' ' + hashUri(path.parent_path(), uri, reach);
    return io::computeContentHash(hashes);
}

} // namespace shutter::gltf
