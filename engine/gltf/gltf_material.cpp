// SPDX-License-Identifier: MIT
#include "engine/gltf/gltf_material.h"

#include "engine/gltf/gltf_texture.h"
#include "engine/gltf/gltf_value.h"

#include <algorithm>

namespace shutter::gltf {

namespace {

/// Half floats hold up to 65504; a brighter surface would become infinite in the picture.
constexpr double kMaxEmissive = 65504.0;

class MaterialReader {
  public:
    MaterialReader(GltfContext& context, GltfTextures& textures, size_t index)
        : mContext(context), mTextures(textures), mSource(context.model.materials[index]),
          mPath(fmt::format("materials[{}]", index)) {}

    scene::Material read() {
        scene::Material material;
        material.name = mSource.name;
        readFactors(material);
        readTextures(material);
        readAlpha(material);
        material.doubleSided = mSource.doubleSided;
        material.unlit = findExtension(mSource.extensions, "KHR_materials_unlit") != nullptr;
        return material;
    }

  private:
    float clamped(double value, double low, double high, const char* key) {
        if (!(value >= low && value <= high)) {
            mContext.warnings.add(
                fmt::format("{}.{} is {}: clamped to [{}, {}]", mPath, key, value, low, high)
            );
        }
        return float(std::clamp(value, low, high));
    }

    void readFactors(scene::Material& material) {
        const tinygltf::PbrMetallicRoughness& pbr = mSource.pbrMetallicRoughness;
        for (int i = 0; i < 4; ++i) {
            material.baseColorFactor[i] = clamped(
                pbr.baseColorFactor[size_t(i)], 0.0, 1.0, "pbrMetallicRoughness.baseColorFactor"
            );
        }
        material.metallicFactor =
            clamped(pbr.metallicFactor, 0.0, 1.0, "pbrMetallicRoughness.metallicFactor");
        material.roughnessFactor =
            clamped(pbr.roughnessFactor, 0.0, 1.0, "pbrMetallicRoughness.roughnessFactor");
        double strength = 1.0;
        const std::string extension = "KHR_materials_emissive_strength";
        if (const auto* object = findExtension(mSource.extensions, extension)) {
            strength = findNumber(*object, "emissiveStrength", mPath + ".extensions." + extension)
                           .value_or(1.0);
        }
        for (int i = 0; i < 3 && !mSource.emissiveFactor.empty(); ++i) {
            const double factor = std::clamp(mSource.emissiveFactor[size_t(i)], 0.0, 1.0);
            material.emissive[i] =
                clamped(factor * strength, 0.0, kMaxEmissive, "emissiveFactor times strength");
        }
    }

    void readTextures(scene::Material& material) {
        const tinygltf::PbrMetallicRoughness& pbr = mSource.pbrMetallicRoughness;
        material.baseColor = slot(pbr.baseColorTexture, "pbrMetallicRoughness.baseColorTexture");
        material.metallicRoughness =
            slot(pbr.metallicRoughnessTexture, "pbrMetallicRoughness.metallicRoughnessTexture");
        material.normal = slot(mSource.normalTexture, "normalTexture");
        material.occlusion = slot(mSource.occlusionTexture, "occlusionTexture");
        material.emissiveTexture = slot(mSource.emissiveTexture, "emissiveTexture");
        constexpr double kMaxNormalScale = 1000.0;
        material.normalScale = clamped(
            mSource.normalTexture.scale, -kMaxNormalScale, kMaxNormalScale, "normalTexture.scale"
        );
        material.occlusionStrength =
            clamped(mSource.occlusionTexture.strength, 0.0, 1.0, "occlusionTexture.strength");
    }

    template <class Info> scene::TextureSlot slot(const Info& info, const char* key) {
        return mTextures.addSlot(info.index, info.texCoord, info.extensions, mPath + "." + key);
    }

    void readAlpha(scene::Material& material) {
        if (mSource.alphaMode == "MASK") {
            material.alphaMode = scene::AlphaMode::Mask;
        } else if (mSource.alphaMode == "BLEND") {
            material.alphaMode = scene::AlphaMode::Blend;
        } else if (mSource.alphaMode != "OPAQUE") {
            failGltf("{}.alphaMode '{}' is unknown", mPath, mSource.alphaMode);
        }
        // A cutoff above 1 is allowed: it hides the surface.
        constexpr double kMaxCutoff = 1e6;
        material.alphaCutoff = clamped(mSource.alphaCutoff, 0.0, kMaxCutoff, "alphaCutoff");
    }

    GltfContext& mContext;
    GltfTextures& mTextures;
    const tinygltf::Material& mSource;
    std::string mPath;
};

} // namespace

void loadMaterials(GltfContext& context, scene::Assets& assets) {
    GltfTextures textures(context, assets);
    for (size_t i = 0; i < context.model.materials.size(); ++i) {
        assets.materials.push_back(MaterialReader(context, textures, i).read());
    }
}

} // namespace shutter::gltf
