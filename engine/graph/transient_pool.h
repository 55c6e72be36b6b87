// SPDX-License-Identifier: MIT
#pragma once

#include "engine/gpu/device.h"
#include "engine/gpu/memory.h"
#include "engine/graph/compile.h"
#include "engine/graph/kept_objects.h"

#include <cstdint>
#include <unordered_map>
#include <vector>

namespace shutter::graph {

/// The images and buffers behind the transients of frames that do not overlap. They outlive the
/// plan that requested them: plans change when motion starts or stops, and drivers may take tens of
/// milliseconds to allocate. The block of memory that images share only grows; images that wait for
/// their plan to come back cost handles, buffers no more memory than the largest plan uses.
class TransientPool {
  public:
    explicit TransientPool(gpu::Device& device) : mDevice(device) {}

    TransientPool(const TransientPool&) = delete;
    TransientPool& operator=(const TransientPool&) = delete;

    /// Frees everything if the last frame's pictures had another size: images of that size are
    /// unlikely to be needed soon and may be far larger. Must be called before realize(), which
    /// see.
    void keepFor(uint32_t width, uint32_t height);

    /// Creates the resources of `plan`. Afterwards image() and buffer() return them. On a device of
    /// our own more memory is taken once the device is idle and has given back what this pool held;
    /// nothing may have been recorded into the frame so far. On a host's, the GPU must have
    /// finished with the frame this pool was used for before. Throws gpu::DeviceError.
    void realize(const Graph& graph, const Plan& plan);
    [[nodiscard]] const gpu::Image* image(uint32_t resource) const;   ///< null: not a transient
    [[nodiscard]] const gpu::Buffer* buffer(uint32_t resource) const; ///< null: not a transient

    /// Bytes of device memory held now.
    [[nodiscard]] VkDeviceSize heldBytes() const;
    /// Gives everything back.
    void clear();

    /// For compile(): queries the driver (cached). Must not be called after this pool is destroyed.
    [[nodiscard]] RequirementFunction requirementFunction();

  private:
    /// Creation parameters of an image or buffer; equal keys, equal objects.
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

    void realizeImages(const Graph& graph, const Plan& plan);
    void realizeBuffers(const Graph& graph, const Plan& plan);
    /// Gives back the block and the images in it.
    void clearImages();
    /// Waits for the device and frees what was given back; on a host's device the host's frames do.
    void freeRetired();
    MemoryRequirement askRequirement(const TransientImageDesc& desc, VkImageUsageFlags usage);

    gpu::Device& mDevice;
    VkExtent2D mSize{};      ///< of keepFor()
    gpu::MemoryBlock mBlock; // before mImages: it must outlive them
    VkDeviceSize mBlockBytes = 0;
    VkDeviceSize mMostBufferBytes = 0; ///< of any plan so far
    KeptObjects<ImageKey, gpu::Image> mImages;
    KeptObjects<BufferKey, gpu::Buffer> mBuffers;
    std::unordered_map<uint32_t, const gpu::Image*> mImageSlots;   ///< by resource
    std::unordered_map<uint32_t, const gpu::Buffer*> mBufferSlots; ///< by resource
    std::vector<KnownRequirement> mRequirements;
};

} // namespace shutter::graph
