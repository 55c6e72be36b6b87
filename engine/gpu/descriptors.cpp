// SPDX-License-Identifier: MIT
#include "engine/gpu/descriptors.h"

#include <array>

namespace shutter::gpu {

namespace {

constexpr uint32_t kSetsPerPool = 256;

} // namespace

DescriptorArena::DescriptorArena(Device& device) : mDevice(device) {}

DescriptorArena::~DescriptorArena() {
    for (VkDescriptorPool pool : mPools)
        mDevice.retire([device = mDevice.handle(), pool] {
            vkDestroyDescriptorPool(device, pool, nullptr);
        });
}

void DescriptorArena::grow() {
    std::vector<VkDescriptorPoolSize> sizes = {
        {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 8 * kSetsPerPool},
        {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, 4 * kSetsPerPool},
        {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 2 * kSetsPerPool},
    };
    if (mDevice.hasRays())
        sizes.push_back({VK_DESCRIPTOR_TYPE_ACCELERATION_STRUCTURE_KHR, kSetsPerPool});
    VkDescriptorPoolCreateInfo info{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
    info.maxSets = kSetsPerPool;
    info.poolSizeCount = static_cast<uint32_t>(sizes.size());
    info.pPoolSizes = sizes.data();
    VkDescriptorPool pool = VK_NULL_HANDLE;
    require(vkCreateDescriptorPool(mDevice.handle(), &info, nullptr, &pool), "making descriptors");
    mPools.push_back(pool);
}

VkDescriptorSet DescriptorArena::allocate(VkDescriptorSetLayout layout) {
    if (mPools.empty())
        grow();
    VkDescriptorSetAllocateInfo info{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO};
    info.descriptorSetCount = 1;
    info.pSetLayouts = &layout;
    VkDescriptorSet set = VK_NULL_HANDLE;
    while (true) {
        info.descriptorPool = mPools[mCurrent];
        const VkResult result = vkAllocateDescriptorSets(mDevice.handle(), &info, &set);
        if (result == VK_SUCCESS)
            return set;
        if (result != VK_ERROR_OUT_OF_POOL_MEMORY && result != VK_ERROR_FRAGMENTED_POOL)
            require(result, "allocating descriptors");
        if (++mCurrent == mPools.size())
            grow();
    }
}

void DescriptorArena::reset() {
    for (VkDescriptorPool pool : mPools)
        vkResetDescriptorPool(mDevice.handle(), pool, 0);
    mCurrent = 0;
}

BindingList& BindingList::sampled(VkImageView view, VkSampler sampler) {
    Entry entry{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER};
    entry.image = {sampler, view, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
    mEntries.push_back(entry);
    return *this;
}

BindingList& BindingList::storage(const Image& image) {
    Entry entry{VK_DESCRIPTOR_TYPE_STORAGE_IMAGE};
    entry.image = {VK_NULL_HANDLE, image.view(), VK_IMAGE_LAYOUT_GENERAL};
    entry.storage = &image;
    mEntries.push_back(entry);
    return *this;
}

BindingList& BindingList::buffer(VkBuffer buffer) {
    Entry entry{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER};
    entry.buffer = {buffer, 0, VK_WHOLE_SIZE};
    mEntries.push_back(entry);
    return *this;
}

BindingList& BindingList::accelerationStructure(VkAccelerationStructureKHR structure) {
    Entry entry{VK_DESCRIPTOR_TYPE_ACCELERATION_STRUCTURE_KHR};
    entry.structure = structure;
    mEntries.push_back(entry);
    return *this;
}

core::Status BindingList::checkFormats(const Pipeline& pipeline) const {
    for (size_t i = 0; i < mEntries.size(); ++i) {
        const Image* image = mEntries[i].storage;
        const VkFormat declared = pipeline.storageFormat(i);
        if (!image || declared == VK_FORMAT_UNDEFINED || image->desc().format == declared)
            continue;
        return core::makeError(
            "the pipeline '{}' declares binding {} as {}, and the image '{}' bound there is {}",
            pipeline.name(),
            i,
            nameFormat(declared),
            image->name(),
            nameFormat(image->desc().format)
        );
    }
    return {};
}

void BindingList::write(const Device& device, VkDescriptorSet set) const {
    std::vector<VkWriteDescriptorSet> writes(mEntries.size());
    std::vector<VkWriteDescriptorSetAccelerationStructureKHR> structures(mEntries.size());
    for (size_t i = 0; i < mEntries.size(); ++i) {
        const Entry& entry = mEntries[i];
        VkWriteDescriptorSet& write = writes[i];
        write = {VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET};
        write.dstSet = set;
        write.dstBinding = static_cast<uint32_t>(i);
        write.descriptorCount = 1;
        write.descriptorType = entry.type;
        write.pImageInfo = &entry.image;
        write.pBufferInfo = &entry.buffer;
        if (entry.type == VK_DESCRIPTOR_TYPE_ACCELERATION_STRUCTURE_KHR) {
            structures[i] = {VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET_ACCELERATION_STRUCTURE_KHR};
            structures[i].accelerationStructureCount = 1;
            structures[i].pAccelerationStructures = &entry.structure;
            write.pNext = &structures[i];
        }
    }
    vkUpdateDescriptorSets(
        device.handle(), static_cast<uint32_t>(writes.size()), writes.data(), 0, nullptr
    );
}

} // namespace shutter::gpu
