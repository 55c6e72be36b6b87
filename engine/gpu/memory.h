// SPDX-License-Identifier: MIT
// Buffers and images with dedicated memory. Few and large by design: meshes share one buffer,
// transient images share the render graph's memory.
#pragma once

#include "engine/gpu/device.h"
#include "engine/gpu/memory_type.h"
#include "engine/gpu/vulkan.h"

#include <cstdint>
#include <cstring>
#include <span>
#include <string>

namespace shutter::gpu {

class Buffer {
  public:
    Buffer() = default;
    /// \param bytes 0 makes a buffer of 16 bytes, so that empty scenes need no special case
    /// Always usable as transfer source, transfer target and by device address. Throws DeviceError
    /// where no memory that serves `use` is left.
    Buffer(
        Device& device,
        std::string name,
        VkDeviceSize bytes,
        VkBufferUsageFlags usage,
        MemoryUse use
    );
    ~Buffer();
    Buffer(Buffer&& other) noexcept;
    Buffer& operator=(Buffer&& other) noexcept;

    [[nodiscard]] VkBuffer handle() const { return mBuffer; }

    [[nodiscard]] VkDeviceSize bytes() const { return mBytes; }

    [[nodiscard]] VkDeviceAddress address() const { return mAddress; }

    /// Null for MemoryUse::Device. For reading: shows the GPU's writes as of this call (after a
    /// barrier to the host and a wait), so call it again after each wait.
    [[nodiscard]] const void* mapped() const;

    [[nodiscard]] explicit operator bool() const { return mBuffer != VK_NULL_HANDLE; }

    /// Copies into mapped memory.
    template <class T> void write(std::span<const T> data, VkDeviceSize offset = 0) {
        writeBytes(data.data(), data.size_bytes(), offset);
    }

    void writeBytes(const void* data, VkDeviceSize bytes, VkDeviceSize offset);

    /// Fills mapped memory with zeros.
    void writeZeros();

  private:
    void release();
    [[nodiscard]] VkMappedMemoryRange mappedRange() const;
    void flush();

    Device* mDevice = nullptr;
    VkBuffer mBuffer = VK_NULL_HANDLE;
    VkDeviceMemory mMemory = VK_NULL_HANDLE;
    VkDeviceSize mMemoryBytes = 0;
    VkDeviceSize mBytes = 0;
    VkDeviceAddress mAddress = 0;
    void* mMapped = nullptr;
    bool mIsCoherent = true;
};

struct ImageDesc {
    uint32_t width = 1;
    uint32_t height = 1;
    VkFormat format = VK_FORMAT_UNDEFINED;
    VkImageUsageFlags usage = 0;
    uint32_t mipLevels = 1;
    uint32_t samples = 1; ///< per pixel
    uint32_t layer = 0;   ///< of an adopted image that has several: the one that is used

    bool operator==(const ImageDesc&) const = default;
};

/// Bytes of one texel of the uncompressed formats this engine uses.
[[nodiscard]] uint32_t texelBytes(VkFormat format);
/// "R16G16B16A16_SFLOAT": Vulkan's name without VK_FORMAT_; "format N" for one not used here.
[[nodiscard]] std::string nameFormat(VkFormat format);
[[nodiscard]] VkImageAspectFlags aspectOf(VkFormat format);

/// A 2D image and its views. Owns its memory unless it was bound to memory of another owner, and
/// the image unless it was adopted.
class Image {
  public:
    Image() = default;
    /// Creates it with dedicated memory.
    Image(Device& device, std::string name, const ImageDesc& desc);
    /// Creates it without memory: query requirements(), then bind().
    [[nodiscard]] static Image
    createUnbound(Device& device, std::string name, const ImageDesc& desc);
    /// Wraps an image of another owner, which must outlive this object and its last use; only the
    /// views are owned.
    [[nodiscard]] static Image
    adopt(Device& device, std::string name, VkImage image, const ImageDesc& desc);
    ~Image();
    Image(Image&& other) noexcept;
    Image& operator=(Image&& other) noexcept;

    [[nodiscard]] VkMemoryRequirements requirements() const;
    /// \param memory must outlive the image
    void bind(VkDeviceMemory memory, VkDeviceSize offset);

    [[nodiscard]] VkImage handle() const { return mImage; }

    /// The view of the image; of a format with depth and stencil, of its depth.
    [[nodiscard]] VkImageView view() const { return mView; }

    /// Null: the format has no stencil beside its depth.
    [[nodiscard]] VkImageView stencilView() const { return mStencilView; }

    [[nodiscard]] const ImageDesc& desc() const { return mDesc; }

    [[nodiscard]] const std::string& name() const { return mName; }

  private:
    void createView();
    void release();

    Device* mDevice = nullptr;
    std::string mName;
    ImageDesc mDesc;
    VkImage mImage = VK_NULL_HANDLE;
    VkImageView mView = VK_NULL_HANDLE;
    VkImageView mStencilView = VK_NULL_HANDLE;
    VkDeviceMemory mMemory = VK_NULL_HANDLE; ///< null: bound to memory of another owner
    VkDeviceSize mMemoryBytes = 0;
    bool mAdopted = false;
};

/// A block of device memory that images are placed into.
class MemoryBlock {
  public:
    MemoryBlock() = default;
    MemoryBlock(Device& device, VkDeviceSize bytes, uint32_t typeBits);
    ~MemoryBlock();
    MemoryBlock(MemoryBlock&& other) noexcept;
    MemoryBlock& operator=(MemoryBlock&& other) noexcept;

    [[nodiscard]] VkDeviceMemory handle() const { return mMemory; }

    [[nodiscard]] uint32_t type() const { return mType; } ///< index of its memory type

    [[nodiscard]] explicit operator bool() const { return mMemory != VK_NULL_HANDLE; }

  private:
    void release();

    Device* mDevice = nullptr;
    VkDeviceMemory mMemory = VK_NULL_HANDLE;
    VkDeviceSize mMemoryBytes = 0;
    uint32_t mType = 0;
};

} // namespace shutter::gpu
