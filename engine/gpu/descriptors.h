// SPDX-License-Identifier: MIT
#pragma once

#include "engine/gpu/device.h"
#include "engine/gpu/vulkan.h"

#include <cstdint>
#include <vector>

namespace shutter::gpu {

/// Descriptor sets that live for one frame. Reset when the frame comes round again.
class DescriptorArena {
  public:
    explicit DescriptorArena(Device& device);
    ~DescriptorArena();
    DescriptorArena(const DescriptorArena&) = delete;
    DescriptorArena& operator=(const DescriptorArena&) = delete;

    [[nodiscard]] VkDescriptorSet allocate(VkDescriptorSetLayout layout);
    void reset();

  private:
    void grow();

    Device& mDevice;
    std::vector<VkDescriptorPool> mPools;
    size_t mCurrent = 0;
};

/// Collects what is bound at 0, 1, 2, ... of one set, in that order, and writes it.
class BindingList {
  public:
    BindingList& sampled(VkImageView view, VkSampler sampler);
    BindingList& storage(VkImageView view);
    BindingList& buffer(VkBuffer buffer);
    BindingList& accelerationStructure(VkAccelerationStructureKHR structure);

    [[nodiscard]] size_t count() const { return mEntries.size(); }

    void write(const Device& device, VkDescriptorSet set) const;

  private:
    struct Entry {
        VkDescriptorType type;
        VkDescriptorImageInfo image{};
        VkDescriptorBufferInfo buffer{};
        VkAccelerationStructureKHR structure = VK_NULL_HANDLE;
    };

    std::vector<Entry> mEntries;
};

} // namespace shutter::gpu
