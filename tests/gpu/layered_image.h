// SPDX-License-Identifier: MIT
// An image of two layers, such as a headset's eyes.
#pragma once

#include "engine/gpu/memory.h"
#include "engine/gpu/vulkan.h"
#include "tests/gpu/embedding_host.h"

namespace shutter::test {

class TwoLayers {
  public:
    TwoLayers(gpu::Device& device, VkFormat format, VkExtent2D extent)
        : mDevice(device.handle()), mExtent(extent) {
        VkImageCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO};
        info.imageType = VK_IMAGE_TYPE_2D;
        info.format = format;
        info.extent = {extent.width, extent.height, 1};
        info.mipLevels = 1;
        info.arrayLayers = 2;
        info.samples = VK_SAMPLE_COUNT_1_BIT;
        info.usage = usage;
        gpu::require(vkCreateImage(mDevice, &info, nullptr, &image), "creating layers");
        VkMemoryRequirements needs{};
        vkGetImageMemoryRequirements(mDevice, image, &needs);
        mMemory = gpu::MemoryBlock(device, needs.size, needs.memoryTypeBits);
        gpu::require(vkBindImageMemory(mDevice, image, mMemory.handle(), 0), "binding layers");
    }

    ~TwoLayers() { vkDestroyImage(mDevice, image, nullptr); }

    TwoLayers(const TwoLayers&) = delete;
    TwoLayers& operator=(const TwoLayers&) = delete;

    /// The layer is as kWritten says afterwards.
    void copyFrom(VkCommandBuffer commands, const gpu::Buffer& texels, uint32_t layer) const {
        moveOn(commands, image, kNothing, kWritten, layer);
        VkBufferImageCopy region{};
        region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, layer, 1};
        region.imageExtent = {mExtent.width, mExtent.height, 1};
        vkCmdCopyBufferToImage(commands, texels.handle(), image, kWritten.layout, 1, &region);
    }

    static constexpr VkImageUsageFlags usage =
        VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT |
        VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    VkImage image = VK_NULL_HANDLE;

  private:
    VkDevice mDevice;
    VkExtent2D mExtent;
    gpu::MemoryBlock mMemory;
};

} // namespace shutter::test
