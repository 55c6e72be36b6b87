// SPDX-License-Identifier: MIT
// Every input of shared/gltf-malformed through the loader; see the README there for the classes.
#include "engine/gltf/gltf_loader.h"
#include "engine/scene/deformed_bounds.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <sys/resource.h>
#include <vector>

namespace shutter::gltf {
namespace {

namespace fs = std::filesystem;

const fs::path kFolder = fs::path(SHUTTER_SHARED_DIR) / "gltf-malformed";

struct Entry {
    std::string file;
    std::string expect;
    std::string why;
};

std::vector<Entry> readManifest() {
    std::ifstream stream(kFolder / "manifest.json");
    std::vector<Entry> entries;
    for (const nlohmann::json& item : nlohmann::json::parse(stream)) {
        entries.push_back({item.at("file"), item.at("expect"), item.at("why")});
    }
    return entries;
}

/// One line, not cut off, and it names the file.
void expectClearMessage(const std::string& message, const Entry& entry) {
    EXPECT_NE(message.find(fs::path(entry.file).filename().string()), std::string::npos) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    EXPECT_LT(message.size(), 1000u) << message;
}

std::string requiredExtension(const Entry& entry) {
    std::ifstream stream(kFolder / entry.file);
    const nlohmann::json root = nlohmann::json::parse(stream);
    return root.at("extensionsRequired").at(0);
}

bool isFinite(const math::vec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// Joints, weights and morph targets.
void expectSoundDeformation(const scene::Primitive& primitive) {
    const size_t count = primitive.positions.size();
    EXPECT_EQ(primitive.influenceCount % 4, 0u);
    EXPECT_EQ(primitive.joints.size(), count * primitive.influenceCount);
    ASSERT_EQ(primitive.weights.size(), count * primitive.influenceCount);
    for (size_t begin = 0; begin < primitive.weights.size(); begin += primitive.influenceCount) {
        double sum = 0.0;
        for (size_t i = begin; i < begin + primitive.influenceCount; ++i) {
            ASSERT_TRUE(primitive.weights[i] >= 0.0f && primitive.weights[i] <= 1.0f);
            sum += double{primitive.weights[i]};
        }
        ASSERT_NEAR(sum, 1.0, 1e-6);
    }
    for (const scene::MorphTarget& target : primitive.morphTargets) {
        for (const std::vector<math::vec3>* deltas :
             {&target.positions, &target.normals, &target.tangents}) {
            EXPECT_TRUE(deltas->empty() || deltas->size() == count);
            for (const math::vec3& delta : *deltas)
                ASSERT_TRUE(isFinite(delta));
        }
        EXPECT_TRUE(target.tangents.empty() || !primitive.tangents.empty());
    }
}

/// Every time is valid.
void expectSoundEntity(const scene::World& world, ecs::Entity entity) {
    const scene::Mesh& mesh =
        world.assets.meshes[world.registry.get<scene::MeshInstance>(entity).mesh];
    if (const auto* morph = world.registry.find<scene::MorphWeights>(entity)) {
        EXPECT_EQ(morph->weights.size(), mesh.morphWeights.size());
    }
    if (const auto* skinned = world.registry.find<scene::Skinned>(entity)) {
        ASSERT_LT(skinned->skin, world.assets.skins.size());
        ASSERT_EQ(skinned->joints.size(), world.assets.skins[skinned->skin].jointFromBind.size());
        for (const scene::Primitive& primitive : mesh.primitives) {
            ASSERT_GT(primitive.influenceCount, 0u);
            for (const uint16_t joint : primitive.joints)
                ASSERT_LT(joint, skinned->joints.size());
        }
    }
    for (const double seconds : {-1.0, 0.0, 0.3, 1e6}) {
        const scene::Deformation pose = scene::deformationAt(world, entity, seconds);
        (void)scene::computeDeformedBounds(scene::computePoseReach(mesh.primitives), pose);
    }
}

void expectSoundPrimitive(const scene::Primitive& primitive, const scene::Assets& assets) {
    const size_t count = primitive.positions.size();
    EXPECT_EQ(primitive.normals.size(), count);
    for (const size_t size :
         {primitive.tangents.size(),
          primitive.uv0.size(),
          primitive.uv1.size(),
          primitive.colors.size()}) {
        EXPECT_TRUE(size == 0 || size == count);
    }
    EXPECT_EQ(primitive.indices.size() % 3, 0u);
    EXPECT_FALSE(primitive.indices.empty());
    for (const uint32_t index : primitive.indices)
        ASSERT_LT(index, count);
    for (const math::vec3& position : primitive.positions)
        ASSERT_TRUE(isFinite(position));
    for (const math::vec3& normal : primitive.normals) {
        ASSERT_NEAR(glm::length(normal), 1.0f, 1e-4f);
    }
    for (const math::vec4& tangent : primitive.tangents) {
        ASSERT_NEAR(glm::length(math::vec3(tangent)), 1.0f, 1e-4f);
        ASSERT_EQ(std::abs(tangent.w), 1.0f);
    }
    if (primitive.material != scene::kNone) {
        EXPECT_LT(primitive.material, assets.materials.size());
    }
    expectSoundDeformation(primitive);
}

void expectSoundMaterial(const scene::Material& material, const scene::Assets& assets) {
    for (const scene::TextureSlot* slot :
         {&material.baseColor,
          &material.metallicRoughness,
          &material.normal,
          &material.occlusion,
          &material.emissiveTexture}) {
        EXPECT_LE(slot->uvSet, 1u);
        if (slot->texture == scene::kNone)
            continue;
        ASSERT_LT(slot->texture, assets.textures.size());
        const scene::AssetIndex image = assets.textures[slot->texture].image;
        ASSERT_LT(image, assets.images.size());
        const scene::TextureImage& pixels = assets.images[image];
        EXPECT_EQ(pixels.rgba.size(), size_t(pixels.width) * pixels.height * 4);
        EXPECT_GT(pixels.rgba.size(), 0u);
    }
}

/// The promises of scene/assets.h, which everything after the loader relies on.
void expectSound(const scene::World& world) {
    for (const scene::Mesh& mesh : world.assets.meshes) {
        for (const scene::Primitive& primitive : mesh.primitives) {
            expectSoundPrimitive(primitive, world.assets);
            EXPECT_EQ(primitive.morphTargets.size(), mesh.morphWeights.size());
        }
    }
    for (const scene::Material& material : world.assets.materials) {
        expectSoundMaterial(material, world.assets);
    }
    for (const auto& [entity, instance] : world.registry.view<const scene::MeshInstance>()) {
        ASSERT_LT(instance.mesh, world.assets.meshes.size());
        if (scene::isDeformable(world, entity))
            expectSoundEntity(world, entity);
    }
    EXPECT_EQ(world.playback.activeClips.size(), world.assets.clips.size());
}

void checkEntry(const Entry& entry) {
    SCOPED_TRACE(entry.file + " (" + entry.expect + "): " + entry.why);
    const auto start = std::chrono::steady_clock::now();
    const core::Result<LoadedScene> loaded = loadGltf(kFolder / entry.file);
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    EXPECT_LT(seconds.count(), 5.0);
    if (loaded) {
        EXPECT_NE(entry.expect, "reject") << "it loaded";
        expectSound(loaded.value().world);
        return;
    }
    const std::string& message = loaded.error().message;
    EXPECT_NE(entry.expect, "load") << message;
    expectClearMessage(message, entry);
    if (entry.expect == "reject-unless-supported") {
        EXPECT_NE(message.find(requiredExtension(entry)), std::string::npos) << message;
    }
}

TEST(MalformedGltf, EveryInputMeetsTheExpectationOfItsManifestBelow512MiBOfMemory) {
    if (!fs::exists(kFolder / "manifest.json"))
        GTEST_SKIP() << kFolder << " is missing";
    const std::vector<Entry> entries = readManifest();
    ASSERT_GT(entries.size(), 100u) << "the manifest lists hardly anything";
    for (const Entry& entry : entries)
        checkEntry(entry);
#if !defined(__SANITIZE_ADDRESS__) // which keeps freed memory
    rusage usage{};
    ASSERT_EQ(getrusage(RUSAGE_SELF, &usage), 0);
    EXPECT_LT(usage.ru_maxrss, 512 * 1024) << "KiB";
#endif
}

} // namespace
} // namespace shutter::gltf
