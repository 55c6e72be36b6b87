// SPDX-License-Identifier: MIT
#pragma once

#include "engine/gpu/device.h"
#include "engine/gpu/memory.h"
#include "engine/graph/compile.h"

#include <cstdint>
#include <unordered_map>
#include <vector>

namespace shutter::graph {

/// The images and buffers behind the transients of one frame in flight. Kept from frame to frame as
/// long as the plan asks for the same ones at the same places; otherwise made anew.
class TransientPool {
  public:
    explicit TransientPool(gpu::Device& device) : mDevice(device) {}

    TransientPool(const TransientPool&) = delete;
    TransientPool& operator=(const TransientPool&) = delete;

    /// Makes what `plan` needs. After it, image() and buffer() answer for its resources. The GPU
    /// must be done with the frame this pool was used for before. Throws gpu::DeviceError.
    void realize(const Graph& graph, const Plan& plan);
    [[nodiscard]] const gpu::Image* image(uint32_t resource) const;   ///< null: not a transient
    [[nodiscard]] const gpu::Buffer* buffer(uint32_t resource) const; ///< null: not a transient

    /// Bytes of device memory held now.
    [[nodiscard]] VkDeviceSize heldBytes() const;
    /// Gives everything back.
    void clear();

    /// For compile(): asks the driver (cached). Must not be called after this pool is gone.
    [[nodiscard]] RequirementFunction requirementFunction();

  private:
    /// What an image or buffer was made from; equal keys, equal objects.
    struct ImageKey {
        TransientImageDesc desc;
        VkImageUsageFlags usage = 0;
        VkDeviceSize offset = 0;
        bool operator==(const ImageKey&) const = default;
    };

    struct BufferKey {
        VkDeviceSize bytes = 0;
        VkBufferUsageFlags usage = 0;
        bool operator==(const BufferKey&) const = default;
    };

    struct KnownRequirement {
        TransientImageDesc desc;
        VkImageUsageFlags usage = 0;
        MemoryRequirement requirement;
    };

    void makeImages(const Graph& graph, const Plan& plan);
    void makeBuffers(const Graph& graph, const Plan& plan);
    MemoryRequirement askRequirement(const TransientImageDesc& desc, VkImageUsageFlags usage);

    gpu::Device& mDevice;
    gpu::MemoryBlock mBlock; // before mImages: it must outlive them
    VkDeviceSize mBlockBytes = 0;
    std::vector<ImageKey> mImageKeys;
    std::vector<gpu::Image> mImages;
    std::vector<BufferKey> mBufferKeys;
    std::vector<gpu::Buffer> mBuffers;
    std::unordered_map<uint32_t, size_t> mImageSlots;  ///< resource -> index of mImages
    std::unordered_map<uint32_t, size_t> mBufferSlots; ///< resource -> index of mBuffers
    std::vector<KnownRequirement> mRequirements;
};

} // namespace shutter::graph
