// SPDX-License-Identifier: MIT
#include "engine/io/gltf_loader.h"

#include "engine/io/file_bytes.h"
#include "engine/io/gltf_accessor.h"
#include "engine/io/gltf_animation.h"
#include "engine/io/gltf_document.h"
#include "engine/io/gltf_instancing.h"
#include "engine/io/gltf_material.h"
#include "engine/io/gltf_mesh.h"
#include "engine/io/gltf_node.h"
#include "engine/io/gltf_schema.h"
#include "engine/io/gltf_skin.h"

#include <exception>
#include <new>
#include <utility>

namespace shutter::io {

namespace {

/// A GLB cannot be longer; nor can a .gltf with embedded data be sensible above.
constexpr uint64_t kMaxFileBytes = uint64_t(4) << 30;

void warnIgnoredExtensions(GltfContext& context) {
    for (const std::string& name : context.model.extensionsUsed) {
        if (!isSupportedExtension(name)) {
            context.warnings.add(fmt::format("the extension {} is ignored", name));
        }
    }
}

/// Throws GltfError and whatever the libraries throw.
LoadedScene buildScene(const std::filesystem::path& folder, std::span<const uint8_t> bytes) {
    const GltfChunks chunks = splitGltf(bytes);
    nlohmann::json root = parseGltfJson(chunks.json);
    checkAssetAndExtensions(root);
    checkGltfSchema(root);
    const GltfResources resources(root, folder, chunks.bin, chunks.hasBin);
    const tinygltf::Model model = parseGltfModel(std::move(root));

    LoadedScene loaded;
    GltfWarnings warnings;
    GltfContext context{model, resources, warnings};
    checkAccessors(context);
    warnIgnoredExtensions(context);
    loadMaterials(context, loaded.world.assets);
    loadMeshes(context, loaded.world.assets);
    loadSkins(context, loaded.world.assets);
    bindMeshes(context, loaded.world.assets);
    const std::vector<ecs::Entity> entities = loadNodes(context, loaded.world);
    addSkins(context, loaded.world, entities);
    loadAnimations(context, loaded.world, entities);
    expandInstances(context, loaded.world, entities);
    loaded.warnings = warnings.take();
    return loaded;
}

} // namespace

core::Result<LoadedScene> loadGltf(const std::filesystem::path& path) try {
    core::Result<std::vector<uint8_t>> bytes = readFileBytes(path, kMaxFileBytes);
    if (!bytes)
        return bytes.error();
    try {
        return buildScene(path.parent_path(), bytes.value());
    } catch (const GltfError& e) {
        return core::makeError("cannot load '{}': {}", path.string(), e.what());
    } catch (const std::bad_alloc&) {
        return core::makeError("cannot load '{}': out of memory", path.string());
    }

} catch (const std::exception& e) {

    // What tinygltf, the JSON parser or the file system may throw beyond what was foreseen.
    return core::makeError("cannot load '{}': {}", path.string(), e.what());
}

} // namespace shutter::io
