// SPDX-License-Identifier: MIT
#include "engine/gpu_scene/texture_table.h"

#include "engine/core/words.h"
#include "engine/gpu/memory_blocks.h"
#include "engine/gpu/pipeline.h"
#include "engine/gpu/upload.h"
#include "engine/gpu_scene/mask_levels.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <span>
#include <utility>

namespace shutter::gpu_scene {

namespace {

/// Descriptors of all kinds that a pass may bind in addition to the textures.
constexpr uint32_t kPassDescriptors = 16;

VkSamplerAddressMode addressMode(scene::Wrap wrap) {
    switch (wrap) {
    case scene::Wrap::MirroredRepeat:
        return VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT;
    case scene::Wrap::ClampToEdge:
        return VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    default:
        return VK_SAMPLER_ADDRESS_MODE_REPEAT;
    }
}

gpu::ImageDesc describeImage(const scene::TextureImage& source, bool srgb) {
    gpu::ImageDesc desc;
    desc.width = source.width;
    desc.height = source.height;
    desc.format = srgb ? VK_FORMAT_R8G8B8A8_SRGB : VK_FORMAT_R8G8B8A8_UNORM;
    desc.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT |
                 VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    desc.mipLevels = gpu::countMipLevels(desc.width, desc.height);
    return desc;
}

} // namespace

TextureLimit findTextureLimit(const VkPhysicalDeviceLimits& limits) {
    TextureLimit least{limits.maxPerStageResources, "maxPerStageResources"};
    for (const TextureLimit& limit :
         {TextureLimit{limits.maxPerStageDescriptorSamplers, "maxPerStageDescriptorSamplers"},
          TextureLimit{
              limits.maxPerStageDescriptorSampledImages, "maxPerStageDescriptorSampledImages"},
          TextureLimit{limits.maxDescriptorSetSamplers, "maxDescriptorSetSamplers"},
          TextureLimit{limits.maxDescriptorSetSampledImages, "maxDescriptorSetSampledImages"}})
        if (limit.count < least.count)
            least = limit;
    least.count -= std::min(least.count, kPassDescriptors);
    return least;
}

TextureTable::TextureTable(
    gpu::Device& device, const scene::Assets& assets, const std::vector<bool>& used
)
    : TextureTable(device) { // made from here on: what throws below leaves nothing behind
    const auto count = static_cast<uint32_t>(used.size());
    const uint32_t places = count + (assets.environment ? 2 : 0);
    const TextureLimit limit = findTextureLimit(device.limits());
    if (places > limit.count)
        throw gpu::DeviceError(fmt::format(
            "the scene has {}, twice each in the table; {} takes a table of {} ({})",
            core::countOf(count / 2, "texture"),
            device.info().name,
            limit.count,
            limit.name
        ));
    createSet(std::max(places, 1u));
    const std::vector<VkImageView> views = uploadImages(assets, used);
    for (uint32_t i = 0; i < count; ++i)
        if (views[i])
            write(i, findSampler(assets.textures[i / 2]), views[i]);
    if (assets.environment)
        addEnvironment(*assets.environment, count);
}

void TextureTable::write(uint32_t place, VkSampler sampler, VkImageView view) {
    const VkDescriptorImageInfo entry{sampler, view, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
    VkWriteDescriptorSet write{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET};
    write.dstSet = mSet;
    write.dstArrayElement = place;
    write.descriptorCount = 1;
    write.descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
    write.pImageInfo = &entry;
    vkUpdateDescriptorSets(mDevice.handle(), 1, &write, 0, nullptr);
}

void TextureTable::addEnvironment(const scene::Environment& environment, uint32_t first) {
    mEnvironment = {first, first + 1};
    addDirections("environment background", environment.background, mEnvironment.background);
    addDirections("environment mirrored", environment.mirrored, mEnvironment.mirrored);
}

void TextureTable::addDirections(
    const char* name, std::span<const scene::DirectionPicture> levels, uint32_t place
) {
    gpu::ImageDesc desc;
    desc.width = levels.front().width;
    desc.height = levels.front().height;
    desc.format = VK_FORMAT_R16G16B16A16_SFLOAT;
    desc.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    desc.mipLevels = static_cast<uint32_t>(levels.size());
    mDirections.emplace_back(mDevice, name, desc);
    std::vector<std::span<const std::byte>> texels;
    for (const scene::DirectionPicture& level : levels)
        texels.push_back(std::as_bytes(std::span(level.rgba)));
    gpu::uploadLevels(mDevice, mDirections.back(), texels);
    // Wrap around the horizon; clamp at the poles.
    scene::Texture around;
    around.wrapU = scene::Wrap::Repeat;
    around.wrapV = scene::Wrap::ClampToEdge;
    write(place, findSampler(around), mDirections.back().view());
}

TextureTable::~TextureTable() {
    mDevice.retire([device = &mDevice, pool = mPool, samplers = mSamplers] {
        vkDestroyDescriptorPool(device->handle(), pool, nullptr);
        for (const KnownSampler& known : samplers)
            vkDestroySampler(device->handle(), known.sampler, nullptr);
        device->living().samplers -= static_cast<uint32_t>(samplers.size());
    });
}

std::vector<VkImageView>
TextureTable::uploadImages(const scene::Assets& assets, const std::vector<bool>& used) {
    // Several textures may show one image.
    std::map<std::pair<scene::AssetIndex, bool>, size_t> known;
    std::vector<scene::AssetIndex> sources;
    std::vector<VkMemoryRequirements> needs;
    for (uint32_t i = 0; i < used.size(); ++i) {
        const scene::AssetIndex source = assets.textures[i / 2].image;
        const bool srgb = i % 2 == 0;
        if (!used[i] || !known.try_emplace({source, srgb}, mImages.size()).second)
            continue;
        mImages.push_back(gpu::Image::createUnbound(
            mDevice, assets.images[source].name, describeImage(assets.images[source], srgb)
        ));
        sources.push_back(source);
        needs.push_back(mImages.back().requirements());
    }
    const gpu::BlockPlan plan = gpu::planBlocks(needs);
    for (const gpu::BlockPlan::Block& block : plan.blocks)
        mBlocks.emplace_back(mDevice, block.bytes, block.typeBits);
    const std::map<scene::AssetIndex, float> masks = findMasks(assets);
    std::vector<gpu::TextureUpload> uploads;
    for (size_t i = 0; i < mImages.size(); ++i) {
        mImages[i].bind(mBlocks[plan.places[i].block].handle(), plan.places[i].offset);
        const scene::TextureImage& source = assets.images[sources[i]];
        const auto mask = masks.find(sources[i]);
        if (mask != masks.end() && mImages[i].desc().format == VK_FORMAT_R8G8B8A8_SRGB)
            uploadMask(source, mask->second, mImages[i]);
        else
            uploads.push_back({&mImages[i], std::as_bytes(std::span(source.rgba))});
    }
    gpu::uploadTextures(mDevice, uploads);
    std::vector<VkImageView> views(used.size(), VK_NULL_HANDLE);
    for (uint32_t i = 0; i < used.size(); ++i)
        if (used[i])
            views[i] = mImages[known.at({assets.textures[i / 2].image, i % 2 == 0})].view();
    return views;
}

void TextureTable::uploadMask(
    const scene::TextureImage& source, float cutoff, const gpu::Image& target
) {
    const std::vector<std::vector<uint8_t>> smaller = makeMaskLevels(source, cutoff);
    std::vector<std::span<const std::byte>> levels{std::as_bytes(std::span(source.rgba))};
    for (const std::vector<uint8_t>& level : smaller)
        levels.push_back(std::as_bytes(std::span(level)));
    gpu::uploadLevels(mDevice, target, levels);
}

VkSampler TextureTable::findSampler(const scene::Texture& texture) {
    for (const KnownSampler& known : mSamplers)
        if (known.nearest == texture.nearest && known.wrapU == texture.wrapU &&
            known.wrapV == texture.wrapV)
            return known.sampler;
    VkSamplerCreateInfo info{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
    info.magFilter = texture.nearest ? VK_FILTER_NEAREST : VK_FILTER_LINEAR;
    info.minFilter = VK_FILTER_LINEAR;
    info.mipmapMode = VK_SAMPLER_MIPMAP_MODE_LINEAR;
    info.maxLod = VK_LOD_CLAMP_NONE;
    info.addressModeU = addressMode(texture.wrapU);
    info.addressModeV = addressMode(texture.wrapV);
    VkSampler sampler = VK_NULL_HANDLE;
    gpu::require(vkCreateSampler(mDevice.handle(), &info, nullptr, &sampler), "making a sampler");
    mSamplers.push_back({texture.nearest, texture.wrapU, texture.wrapV, sampler});
    ++mDevice.living().samplers;
    return sampler;
}

void TextureTable::createSet(uint32_t count) {
    mLayout = mDevice.textureLayout(count);
    const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, count};
    VkDescriptorPoolCreateInfo pool{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
    pool.maxSets = 1;
    pool.poolSizeCount = 1;
    pool.pPoolSizes = &size;
    gpu::require(
        vkCreateDescriptorPool(mDevice.handle(), &pool, nullptr, &mPool),
        "creating the texture table"
    );
    VkDescriptorSetAllocateInfo allocate{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO};
    allocate.descriptorPool = mPool;
    allocate.descriptorSetCount = 1;
    allocate.pSetLayouts = &mLayout;
    gpu::require(
        vkAllocateDescriptorSets(mDevice.handle(), &allocate, &mSet),
        fmt::format("making room for {} textures", count)
    );
}

} // namespace shutter::gpu_scene
