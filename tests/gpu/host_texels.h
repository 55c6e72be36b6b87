// SPDX-License-Identifier: MIT
// Images of a host whose texels are made in main memory.
#pragma once

#include "engine/gpu/memory.h"
#include "tests/gpu/embedding_host.h"

#include <glm/gtc/packing.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace shutter::test {

/// An image of the host with texels of main memory, as the shader reads it afterwards.
class HostTexels {
  public:
    HostTexels(
        gpu::Device& device,
        VkFormat format,
        VkExtent2D extent,
        std::span<const std::byte> texels,
        VkImageUsageFlags more = 0
    )
        : mExtent(extent), mFormat(format),
          mImage(
              device,
              "host's",
              {extent.width,
               extent.height,
               format,
               VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT |
                   VK_IMAGE_USAGE_TRANSFER_SRC_BIT | more}
          ),
          mStaging(device, "staging", texels.size(), 0, gpu::MemoryUse::Staging) {
        mStaging.writeBytes(texels.data(), texels.size(), 0);
    }

    void record(VkCommandBuffer commands) const {
        VkImageMemoryBarrier2 barrier{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2};
        barrier.dstStageMask = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT;
        barrier.dstAccessMask = VK_ACCESS_2_TRANSFER_WRITE_BIT;
        barrier.newLayout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
        barrier.image = mImage.handle();
        barrier.subresourceRange = {gpu::aspectOf(mFormat), 0, 1, 0, 1};
        VkDependencyInfo dependency{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
        dependency.imageMemoryBarrierCount = 1;
        dependency.pImageMemoryBarriers = &barrier;
        vkCmdPipelineBarrier2(commands, &dependency);
        VkBufferImageCopy region{};
        // Depth alone is copied of an image that has a stencil, too.
        region.imageSubresource = {
            gpu::aspectOf(mFormat) & ~VkImageAspectFlags(VK_IMAGE_ASPECT_STENCIL_BIT), 0, 0, 1};
        region.imageExtent = {mExtent.width, mExtent.height, 1};
        vkCmdCopyBufferToImage(
            commands, mStaging.handle(), mImage.handle(), kWritten.layout, 1, &region
        );
    }

    [[nodiscard]] motion_blur::HostImage describe(VkRect2D area = {}) const {
        motion_blur::HostImage image{mImage.handle(), kWritten, kCopied};
        image.format = mFormat;
        image.extent = mExtent;
        image.area = area;
        image.usage = mImage.desc().usage;
        image.samples = VK_SAMPLE_COUNT_1_BIT;
        return image;
    }

    [[nodiscard]] const gpu::Image& image() const { return mImage; }

    [[nodiscard]] VkExtent2D extent() const { return mExtent; }

  private:
    VkExtent2D mExtent;
    VkFormat mFormat;
    gpu::Image mImage;
    gpu::Buffer mStaging;
};

template <class T> [[nodiscard]] std::span<const std::byte> bytesOf(const std::vector<T>& values) {
    return std::as_bytes(std::span<const T>(values));
}

inline uint64_t packHalf(const glm::vec4& value) {
    return glm::packHalf4x16(value);
}

} // namespace shutter::test
