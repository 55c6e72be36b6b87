// SPDX-License-Identifier: MIT
#pragma once

#include "engine/core/result.h"
#include "engine/gpu/device.h"
#include "engine/gpu/memory.h"
#include "engine/gpu/pipeline.h"
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

/// Collects the bindings 0, 1, 2, ... of one set, in that order, and writes them.
class BindingList {
  public:
    BindingList& sampled(VkImageView view, VkSampler sampler);
    /// \param image must outlive this list
    BindingList& storage(const Image& image);
    BindingList& buffer(VkBuffer buffer);
    BindingList& accelerationStructure(VkAccelerationStructureKHR structure);

    [[nodiscard]] size_t count() const { return mEntries.size(); }

    /// Error: a storage image's format differs from the one that the pipeline's shaders declare,
    /// which makes stored values undefined in Vulkan.
    [[nodiscard]] core::Status checkFormats(const Pipeline& pipeline) const;

    void write(const Device& device, VkDescriptorSet set) const;

  private:
    struct Entry {
        VkDescriptorType type;
        VkDescriptorImageInfo image{};
        const Image* storage = nullptr; ///< whose view it is; null for a sampled one
        VkDescriptorBufferInfo buffer{};
        VkAccelerationStructureKHR structure = VK_NULL_HANDLE;
    };

    std::vector<Entry> mEntries;
};

} // namespace shutter::gpu
