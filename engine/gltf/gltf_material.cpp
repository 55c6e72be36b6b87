// SPDX-License-Identifier: MIT
#include "engine/core/words.h"
#include "engine/gltf/gltf_parts.h"
#include "engine/gltf/gltf_values.h"
#include "engine/io/image_file.h"

#include <algorithm>
#include <array>
#include <span>
#include <utility>

namespace shutter::gltf {

namespace {

using scene::AssetIndex;
using scene::kNone;

scene::Wrap readWrap(int code, size_t sampler, const char* key) {
    switch (code) {
    case TINYGLTF_TEXTURE_WRAP_REPEAT:
        return scene::Wrap::Repeat;
    case TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT:
        return scene::Wrap::MirroredRepeat;
    case TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE:
        return scene::Wrap::ClampToEdge;
    default:
        failGltf("samplers[{}].{} is {}, no wrap mode", sampler, key, code);
    }
}

void applySampler(const tinygltf::Model& model, size_t index, scene::Texture& texture) {
    const tinygltf::Sampler& sampler = model.samplers[index];
    texture.wrapU = readWrap(sampler.wrapS, index, "wrapS");
    texture.wrapV = readWrap(sampler.wrapT, index, "wrapT");
    texture.nearest = sampler.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST;
}

/// Fills Assets::textures and Assets::images with what materials use. Images that no material uses
/// are never opened.
class GltfTextures {
  public:
    GltfTextures(GltfContext& context, scene::Assets& assets);

    /// kNone for a texture without a picture that is read.
    [[nodiscard]] scene::AssetIndex addTexture(size_t index);

    /// The slot for a reference to `texture`; its texture is kNone for -1 and for a texture without
    /// a PNG or JPEG source. Applies KHR_texture_transform. Throws GltfError when the image cannot
    /// be decoded.
    [[nodiscard]] scene::TextureSlot addSlot(
        int texture, int texCoord, const tinygltf::ExtensionMap& extensions, const std::string& path
    );

  private:
    [[nodiscard]] scene::AssetIndex addImage(size_t index);

    GltfContext& mContext;
    scene::Assets& mAssets;
    std::vector<scene::AssetIndex>
        mTextureOf;                          ///< by the file's texture index; kNone: not added yet
    std::vector<scene::AssetIndex> mImageOf; ///< by the file's image index; kNone: not added yet
};

GltfTextures::GltfTextures(GltfContext& context, scene::Assets& assets)
    : mContext(context), mAssets(assets), mTextureOf(context.model.textures.size(), kNone),
      mImageOf(context.resources.imageCount(), kNone) {}

scene::TextureSlot GltfTextures::addSlot(
    int texture, int texCoord, const tinygltf::ExtensionMap& extensions, const std::string& path
) {
    scene::TextureSlot slot;
    if (texture < 0)
        return slot;
    slot.uvSet = uint32_t(texCoord);
    if (const auto* transform = findExtension(extensions, "KHR_texture_transform")) {
        const std::string at = path + ".extensions.KHR_texture_transform";
        slot.offset = math::vec2(findVec2(*transform, "offset", at).value_or(math::dvec2(0.0)));
        slot.scale = math::vec2(findVec2(*transform, "scale", at).value_or(math::dvec2(1.0)));
        slot.rotation = float(findNumber(*transform, "rotation", at).value_or(0.0));
        slot.uvSet = findIndex(*transform, "texCoord", at).value_or(slot.uvSet);
    }
    if (slot.uvSet > 1) {
        mContext.warnings.add(fmt::format(
            "{} uses TEXCOORD_{}, but only the sets 0 and 1 are read: drawn without it",
            path,
            slot.uvSet
        ));
        return {};
    }
    slot.texture = addTexture(size_t(texture));
    return slot;
}

AssetIndex GltfTextures::addTexture(size_t index) {
    if (mTextureOf[index] != kNone)
        return mTextureOf[index];
    const tinygltf::Texture& source = mContext.model.textures[index];
    if (source.source < 0) {
        mContext.warnings.add(
            fmt::format("textures[{}] has no picture that is read: drawn without it", index)
        );
        return kNone;
    }
    scene::Texture texture;
    texture.image = addImage(size_t(source.source));
    if (source.sampler >= 0)
        applySampler(mContext.model, size_t(source.sampler), texture);
    mTextureOf[index] = AssetIndex(mAssets.textures.size());
    mAssets.textures.push_back(texture);
    return mTextureOf[index];
}

AssetIndex GltfTextures::addImage(size_t index) {
    if (mImageOf[index] != kNone)
        return mImageOf[index];
    scene::TextureImage image = decodeImage(mContext, index);
    mContext.spendImageBytes(image.rgba.size());
    mImageOf[index] = AssetIndex(mAssets.images.size());
    mAssets.images.push_back(std::move(image));
    return mImageOf[index];
}

/// The largest half float; a brighter surface would become infinite in the picture.
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
        readBlend(material);
        // A cutoff above 1 is valid and hides the whole surface.
        constexpr double kMaxCutoff = 1e6;
        material.alphaCutoff = clamped(mSource.alphaCutoff, 0.0, kMaxCutoff, "alphaCutoff");
    }

    /// OMI_materials_blend (a draft): its mode overrides the material's own.
    void readBlend(scene::Material& material) {
        const std::string extension = "OMI_materials_blend";
        const auto* object = findExtension(mSource.extensions, extension);
        if (object == nullptr)
            return;
        const std::string at = mPath + ".extensions." + extension;
        constexpr std::array kRead{
            scene::BlendMode::Over, scene::BlendMode::Add, scene::BlendMode::Premultiplied};
        const auto mode = findName(
            *object,
            "alphaMode",
            {"BLEND",
             "ADD",
             "PREMULT",
             "HASH",
             "MULTIPLY",
             "SUBTRACT",
             "REV_SUBTRACT",
             "MAX",
             "MIN"},
            at
        );
        if (!mode || *mode >= kRead.size()) {
            mContext.warnings.add(
                fmt::format("{} has no alphaMode that is read: the material's own is used", at)
            );
            return;
        }
        material.blendMode = kRead[*mode];
        material.alphaMode = scene::AlphaMode::Blend;
    }

    GltfContext& mContext;
    GltfTextures& mTextures;
    const tinygltf::Material& mSource;
    std::string mPath;
};

/// The texture that the node's extras name, which the file has. Throws GltfError.
std::optional<uint32_t>
findLooseTexture(const GltfContext& context, size_t node, const ExtraReader& reader) {
    if (reader.textureMember.empty())
        return std::nullopt;
    const std::string name(reader.name);
    const std::string path = fmt::format("nodes[{}]", node);
    const tinygltf::Value* object = findExtra(context.model.nodes[node].extras, name, path);
    if (!object)
        return std::nullopt;
    const std::string at = fmt::format("{}.extras.{}", path, name);
    const std::string member(reader.textureMember);
    const std::optional<uint32_t> index = findIndex(*object, member, at);
    const size_t count = context.model.textures.size();
    if (index && *index >= count)
        failGltf("{}.{} is {}, but {}", at, member, *index, core::thereAre(count, "texture"));
    return index;
}

} // namespace

scene::TextureImage decodeImage(const GltfContext& context, size_t index) {
    const std::string label = context.resources.imageLabel(index);
    const int viewIndex = context.resources.imageBufferView(index);
    std::vector<uint8_t> file;
    std::span<const uint8_t> encoded;
    if (viewIndex >= 0) {
        const tinygltf::BufferView& view = context.model.bufferViews[size_t(viewIndex)];
        encoded =
            context.resources.buffer(size_t(view.buffer)).subspan(view.byteOffset, view.byteLength);
    } else {
        file = context.resources.readImageUri(index);
        encoded = file;
    }
    core::Result<scene::TextureImage> image = io::decodeTexture(encoded, label);
    if (!image)
        failGltf("{}", image.error().message);
    return std::move(image).value();
}

void loadMaterials(GltfContext& context, scene::Assets& assets) {
    GltfTextures textures(context, assets);
    for (size_t i = 0; i < context.model.materials.size(); ++i) {
        assets.materials.push_back(MaterialReader(context, textures, i).read());
    }
    for (size_t i = 0; i < context.model.nodes.size(); ++i)
        for (const ExtraReader& reader : context.readers) {
            const auto index = findLooseTexture(context, i, reader);
            if (!index)
                continue;
            const AssetIndex texture = textures.addTexture(*index);
            context.looseTextures[*index] = texture;
            if (texture != kNone)
                assets.textures[texture].isLoose = true;
        }
}

} // namespace shutter::gltf
