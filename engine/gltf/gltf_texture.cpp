// SPDX-License-Identifier: MIT
#include "engine/gltf/gltf_texture.h"

#include "engine/gltf/gltf_value.h"
#include "engine/io/image_file.h"

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

} // namespace

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
    scene::TextureImage image = decodeImage(index);
    if (image.rgba.size() > mContext.imageBytesLeft) {
        failGltf("its textures need over 4 GiB when decoded");
    }
    mContext.imageBytesLeft -= image.rgba.size();
    mImageOf[index] = AssetIndex(mAssets.images.size());
    mAssets.images.push_back(std::move(image));
    return mImageOf[index];
}

scene::TextureImage GltfTextures::decodeImage(size_t index) {
    const std::string label = mContext.resources.imageLabel(index);
    const int viewIndex = mContext.resources.imageBufferView(index);
    std::vector<uint8_t> file;
    std::span<const uint8_t> encoded;
    if (viewIndex >= 0) {
        const tinygltf::BufferView& view = mContext.model.bufferViews[size_t(viewIndex)];
        encoded = mContext.resources.buffer(size_t(view.buffer))
                      .subspan(view.byteOffset, view.byteLength);
    } else {
        file = mContext.resources.readImageUri(index);
        encoded = file;
    }
    core::Result<scene::TextureImage> image = io::decodeTexture(encoded, label);
    if (!image)
        failGltf("{}", image.error().message);
    return std::move(image).value();
}

} // namespace shutter::gltf
