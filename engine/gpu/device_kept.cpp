// SPDX-License-Identifier: MIT
// What a device keeps for those who come later: layouts of texture tables, and pipelines.
#include "engine/gpu/device.h"

namespace shutter::gpu {

namespace {

void destroy(VkDevice device, const PipelineObjects& objects) {
    vkDestroyPipeline(device, objects.pipeline, nullptr);
    vkDestroyPipelineLayout(device, objects.layout, nullptr);
    vkDestroyDescriptorSetLayout(device, objects.setLayout, nullptr);
}

} // namespace

VkDescriptorSetLayout Device::textureLayout(uint32_t count) {
    const auto known = mTextureLayouts.find(count);
    if (known != mTextureLayouts.end())
        return known->second;
    VkDescriptorSetLayoutBinding binding{};
    binding.descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
    binding.descriptorCount = count;
    binding.stageFlags = kSceneStages;
    if (mInfo.rayTier != RayTier::Pipeline)
        binding.stageFlags &= VK_SHADER_STAGE_FRAGMENT_BIT | VK_SHADER_STAGE_COMPUTE_BIT;
    const VkDescriptorBindingFlags flags = VK_DESCRIPTOR_BINDING_PARTIALLY_BOUND_BIT;
    VkDescriptorSetLayoutBindingFlagsCreateInfo bindingFlags{
        VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_BINDING_FLAGS_CREATE_INFO};
    bindingFlags.bindingCount = 1;
    bindingFlags.pBindingFlags = &flags;
    VkDescriptorSetLayoutCreateInfo info{
        VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO, &bindingFlags};
    info.bindingCount = 1;
    info.pBindings = &binding;
    VkDescriptorSetLayout layout = VK_NULL_HANDLE;
    require(
        vkCreateDescriptorSetLayout(mDevice, &info, nullptr, &layout),
        "creating the layout of the texture table"
    );
    mTextureLayouts.emplace(count, layout);
    return layout;
}

std::optional<PipelineObjects> Device::takePipeline(const std::string& key) {
    return mKeptPipelines.take(key);
}

void Device::giveUpPipeline(std::string key, const PipelineObjects& objects) {
    if (const auto leaves = mKeptPipelines.keep(std::move(key), objects))
        retire([device = mDevice, objects = *leaves] { destroy(device, objects); });
}

void Device::destroyKept() {
    for (const PipelineObjects& objects : mKeptPipelines.takeAll())
        destroy(mDevice, objects);
    for (const auto& [count, layout] : mTextureLayouts)
        vkDestroyDescriptorSetLayout(mDevice, layout, nullptr);
    mTextureLayouts.clear();
}

} // namespace shutter::gpu
