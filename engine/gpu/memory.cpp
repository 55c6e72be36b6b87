// SPDX-License-Identifier: MIT
#include "engine/gpu/memory.h"

#include "engine/core/check.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace shutter::gpu {

namespace {

struct Allocation {
    VkDeviceMemory memory = VK_NULL_HANDLE;
    uint32_t type = 0;
};

Allocation allocate(
    Device& device,
    const VkMemoryRequirements& needs,
    MemoryUse use,
    bool addressable,
    const std::string& name
) {
    VkMemoryAllocateFlagsInfo flags{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_FLAGS_INFO};
    flags.flags = VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT;
    VkMemoryAllocateInfo info{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
    if (addressable)
        info.pNext = &flags;
    info.allocationSize = needs.size;
    VkDeviceMemory memory = VK_NULL_HANDLE;
    const auto types =
        rankMemoryTypes(device.memoryProperties(), needs.memoryTypeBits, use, needs.size);
    if (types.empty())
        throw DeviceError(fmt::format("the device has no memory of the kind '{}' needs", name));
    const TypeAttempt attempt = allocateInTurn(types, [&](uint32_t type) {
        info.memoryTypeIndex = type;
        return vkAllocateMemory(device.handle(), &info, nullptr, &memory);
    });
    require(
        attempt.result, fmt::format("allocating {} MiB for '{}'", (needs.size >> 20) + 1, name)
    );
    device.living().memoryBytes += needs.size;
    ++device.living().memoryBlocks;
    device.countAllocation();
    return {memory, attempt.type};
}

/// \param memory may be null
void freeMemory(Device& device, VkDeviceMemory memory, VkDeviceSize bytes) {
    if (!memory)
        return;
    vkFreeMemory(device.handle(), memory, nullptr);
    device.living().memoryBytes -= bytes;
    --device.living().memoryBlocks;
}

} // namespace

Buffer::Buffer(
    Device& device, std::string name, VkDeviceSize bytes, VkBufferUsageFlags usage, MemoryUse use
)
    : Buffer() { // made from here on: what throws below leaves nothing behind
    mDevice = &device;
    mBytes = std::max<VkDeviceSize>(bytes, 16);
    VkBufferCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
    info.size = mBytes;
    info.usage = usage | VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT |
                 VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT;
    require(
        vkCreateBuffer(device.handle(), &info, nullptr, &mBuffer),
        fmt::format("creating the buffer '{}'", name)
    );
    ++device.living().buffers;
    device.setName(VK_OBJECT_TYPE_BUFFER, reinterpret_cast<uint64_t>(mBuffer), name);
    VkMemoryRequirements needs;
    vkGetBufferMemoryRequirements(device.handle(), mBuffer, &needs);
    const Allocation allocation = allocate(device, needs, use, true, name);
    mMemory = allocation.memory;
    mMemoryBytes = needs.size;
    mIsCoherent = (device.memoryProperties().memoryTypes[allocation.type].propertyFlags &
                   VK_MEMORY_PROPERTY_HOST_COHERENT_BIT) != 0;
    require(vkBindBufferMemory(device.handle(), mBuffer, mMemory, 0), "binding memory");
    if (use != MemoryUse::Device)
        require(vkMapMemory(device.handle(), mMemory, 0, VK_WHOLE_SIZE, 0, &mMapped), "mapping");
    VkBufferDeviceAddressInfo address{VK_STRUCTURE_TYPE_BUFFER_DEVICE_ADDRESS_INFO};
    address.buffer = mBuffer;
    mAddress = vkGetBufferDeviceAddress(device.handle(), &address);
}

Buffer::~Buffer() {
    release();
}

Buffer::Buffer(Buffer&& other) noexcept {
    *this = std::move(other);
}

Buffer& Buffer::operator=(Buffer&& other) noexcept {
    if (this == &other)
        return *this;
    release();
    mDevice = std::exchange(other.mDevice, nullptr);
    mBuffer = std::exchange(other.mBuffer, VK_NULL_HANDLE);
    mMemory = std::exchange(other.mMemory, VK_NULL_HANDLE);
    mMemoryBytes = std::exchange(other.mMemoryBytes, 0);
    mBytes = std::exchange(other.mBytes, 0);
    mAddress = std::exchange(other.mAddress, 0);
    mMapped = std::exchange(other.mMapped, nullptr);
    mIsCoherent = other.mIsCoherent;
    return *this;
}

void Buffer::release() {
    if (!mBuffer)
        return;
    mDevice->retire([device = mDevice, buffer = mBuffer, memory = mMemory, bytes = mMemoryBytes] {
        vkDestroyBuffer(device->handle(), buffer, nullptr);
        --device->living().buffers;
        freeMemory(*device, memory, bytes);
    });
    mBuffer = VK_NULL_HANDLE;
}

void Buffer::writeBytes(const void* data, VkDeviceSize bytes, VkDeviceSize offset) {
    SHUTTER_CHECK(mMapped != nullptr, "the buffer is not mapped");
    SHUTTER_CHECK(offset + bytes <= mBytes, "{} + {} > {}", offset, bytes, mBytes);
    if (bytes > 0)
        std::memcpy(static_cast<char*>(mMapped) + offset, data, bytes);
    flush();
}

void Buffer::writeZeros() {
    SHUTTER_CHECK(mMapped != nullptr, "the buffer is not mapped");
    std::memset(mMapped, 0, mBytes);
    flush();
}

const void* Buffer::mapped() const {
    const VkMappedMemoryRange range = mappedRange();
    if (mMapped != nullptr && !mIsCoherent)
        require(vkInvalidateMappedMemoryRanges(mDevice->handle(), 1, &range), "reading memory");
    return mMapped;
}

void Buffer::flush() {
    const VkMappedMemoryRange range = mappedRange();
    if (!mIsCoherent)
        require(vkFlushMappedMemoryRanges(mDevice->handle(), 1, &range), "writing memory");
}

VkMappedMemoryRange Buffer::mappedRange() const {
    // All of it: a part would have to keep to nonCoherentAtomSize.
    VkMappedMemoryRange range{VK_STRUCTURE_TYPE_MAPPED_MEMORY_RANGE};
    range.memory = mMemory;
    range.size = VK_WHOLE_SIZE;
    return range;
}

uint32_t texelBytes(VkFormat format) {
    switch (format) {
    case VK_FORMAT_R8_UNORM:
    case VK_FORMAT_R8_UINT:
    case VK_FORMAT_S8_UINT:
        return 1;
    case VK_FORMAT_R16_UINT:
    case VK_FORMAT_R16_SFLOAT:
    case VK_FORMAT_D16_UNORM:
        return 2;
    case VK_FORMAT_R8G8B8A8_UNORM:
    case VK_FORMAT_R8G8B8A8_SRGB:
    case VK_FORMAT_B8G8R8A8_UNORM:
    case VK_FORMAT_B8G8R8A8_SRGB:
    case VK_FORMAT_A2B10G10R10_UNORM_PACK32:
    case VK_FORMAT_A2R10G10B10_UNORM_PACK32:
    case VK_FORMAT_R16G16_SFLOAT:
    case VK_FORMAT_R32_UINT:
    case VK_FORMAT_R32_SFLOAT:
    case VK_FORMAT_D32_SFLOAT:
    case VK_FORMAT_X8_D24_UNORM_PACK32:
    case VK_FORMAT_B10G11R11_UFLOAT_PACK32:
        return 4;
    case VK_FORMAT_R16G16B16A16_SFLOAT:
    case VK_FORMAT_R16G16B16A16_UNORM:
    case VK_FORMAT_R32G32_SFLOAT:
    case VK_FORMAT_R32G32_UINT:
        return 8;
    case VK_FORMAT_R32G32B32A32_SFLOAT:
    case VK_FORMAT_R32G32B32A32_SINT:
    case VK_FORMAT_R32G32B32A32_UINT:
        return 16;
    default:
        break;
    }
    SHUTTER_CHECK(false, "format {} has no size here", static_cast<int>(format));
    return 0;
}

std::string nameFormat(VkFormat format) {
    switch (format) {
#define SHUTTER_FORMAT(name)                                                                       \
    case VK_FORMAT_##name:                                                                         \
        return #name;
        SHUTTER_FORMAT(R8_UNORM)
        SHUTTER_FORMAT(R8_UINT)
        SHUTTER_FORMAT(R8G8_UNORM)
        SHUTTER_FORMAT(R8G8B8A8_UNORM)
        SHUTTER_FORMAT(R8G8B8A8_SRGB)
        SHUTTER_FORMAT(B8G8R8A8_UNORM)
        SHUTTER_FORMAT(B8G8R8A8_SRGB)
        SHUTTER_FORMAT(A2B10G10R10_UNORM_PACK32)
        SHUTTER_FORMAT(A2R10G10B10_UNORM_PACK32)
        SHUTTER_FORMAT(R16_UINT)
        SHUTTER_FORMAT(R16_SFLOAT)
        SHUTTER_FORMAT(R16G16_SFLOAT)
        SHUTTER_FORMAT(R16G16B16A16_SFLOAT)
        SHUTTER_FORMAT(R32_UINT)
        SHUTTER_FORMAT(R32_SFLOAT)
        SHUTTER_FORMAT(R32G32_UINT)
        SHUTTER_FORMAT(R32G32_SFLOAT)
        SHUTTER_FORMAT(R32G32B32A32_SINT)
        SHUTTER_FORMAT(R32G32B32A32_UINT)
        SHUTTER_FORMAT(R32G32B32A32_SFLOAT)
        SHUTTER_FORMAT(B10G11R11_UFLOAT_PACK32)
        SHUTTER_FORMAT(R16G16B16A16_UNORM)
        SHUTTER_FORMAT(D16_UNORM)
        SHUTTER_FORMAT(X8_D24_UNORM_PACK32)
        SHUTTER_FORMAT(S8_UINT)
        SHUTTER_FORMAT(D16_UNORM_S8_UINT)
        SHUTTER_FORMAT(D24_UNORM_S8_UINT)
        SHUTTER_FORMAT(D32_SFLOAT_S8_UINT)
        SHUTTER_FORMAT(D32_SFLOAT)
#undef SHUTTER_FORMAT
    default:
        return fmt::format("format {}", static_cast<int>(format));
    }
}

VkImageAspectFlags aspectOf(VkFormat format) {
    switch (format) {
    case VK_FORMAT_D16_UNORM:
    case VK_FORMAT_X8_D24_UNORM_PACK32:
    case VK_FORMAT_D32_SFLOAT:
        return VK_IMAGE_ASPECT_DEPTH_BIT;
    case VK_FORMAT_S8_UINT:
        return VK_IMAGE_ASPECT_STENCIL_BIT;
    case VK_FORMAT_D16_UNORM_S8_UINT:
    case VK_FORMAT_D24_UNORM_S8_UINT:
    case VK_FORMAT_D32_SFLOAT_S8_UINT:
        return VK_IMAGE_ASPECT_DEPTH_BIT | VK_IMAGE_ASPECT_STENCIL_BIT;
    default:
        return VK_IMAGE_ASPECT_COLOR_BIT;
    }
}

Image::Image(Device& device, std::string name, const ImageDesc& desc)
    : Image(createUnbound(device, std::move(name), desc)) {
    const VkMemoryRequirements needs = requirements();
    mMemory = allocate(device, needs, MemoryUse::Device, false, mName).memory;
    mMemoryBytes = needs.size;
    bind(mMemory, 0);
}

Image Image::createUnbound(Device& device, std::string name, const ImageDesc& desc) {
    Image image;
    image.mDevice = &device;
    image.mName = std::move(name);
    image.mDesc = desc;
    VkImageCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO};
    info.imageType = VK_IMAGE_TYPE_2D;
    info.format = desc.format;
    info.extent = {desc.width, desc.height, 1};
    info.mipLevels = desc.mipLevels;
    info.arrayLayers = 1;
    info.samples = static_cast<VkSampleCountFlagBits>(desc.samples);
    info.tiling = VK_IMAGE_TILING_OPTIMAL;
    info.usage = desc.usage;
    require(
        vkCreateImage(device.handle(), &info, nullptr, &image.mImage),
        fmt::format("creating the image '{}' ({} x {})", image.mName, desc.width, desc.height)
    );
    ++device.living().images;
    device.setName(VK_OBJECT_TYPE_IMAGE, reinterpret_cast<uint64_t>(image.mImage), image.mName);
    return image;
}

Image Image::adopt(Device& device, std::string name, VkImage image, const ImageDesc& desc) {
    Image adopted;
    adopted.mDevice = &device;
    adopted.mName = std::move(name);
    adopted.mDesc = desc;
    adopted.mImage = image;
    adopted.mAdopted = true;
    adopted.createView();
    return adopted;
}

Image::~Image() {
    release();
}

Image::Image(Image&& other) noexcept {
    *this = std::move(other);
}

Image& Image::operator=(Image&& other) noexcept {
    if (this == &other)
        return *this;
    release();
    mDevice = std::exchange(other.mDevice, nullptr);
    mName = std::move(other.mName);
    mDesc = other.mDesc;
    mImage = std::exchange(other.mImage, VK_NULL_HANDLE);
    mView = std::exchange(other.mView, VK_NULL_HANDLE);
    mStencilView = std::exchange(other.mStencilView, VK_NULL_HANDLE);
    mMemory = std::exchange(other.mMemory, VK_NULL_HANDLE);
    mMemoryBytes = std::exchange(other.mMemoryBytes, 0);
    mAdopted = other.mAdopted;
    return *this;
}

VkMemoryRequirements Image::requirements() const {
    VkMemoryRequirements needs;
    vkGetImageMemoryRequirements(mDevice->handle(), mImage, &needs);
    return needs;
}

void Image::bind(VkDeviceMemory memory, VkDeviceSize offset) {
    require(vkBindImageMemory(mDevice->handle(), mImage, memory, offset), "binding memory");
    createView();
}

void Image::createView() {
    // Copies need no view, and an image for nothing but copies may not have one.
    constexpr VkImageUsageFlags kTransfer =
        VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    if (!(mDesc.usage & ~kTransfer))
        return;
    VkImageViewCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
    info.image = mImage;
    info.viewType = VK_IMAGE_VIEW_TYPE_2D;
    info.format = mDesc.format;
    // Shaders sample one aspect of an image.
    constexpr VkImageAspectFlags kDepth = VK_IMAGE_ASPECT_DEPTH_BIT;
    constexpr VkImageAspectFlags kBoth = kDepth | VK_IMAGE_ASPECT_STENCIL_BIT;
    const VkImageAspectFlags aspect = aspectOf(mDesc.format);
    info.subresourceRange = {aspect == kBoth ? kDepth : aspect, 0, mDesc.mipLevels, mDesc.layer, 1};
    require(vkCreateImageView(mDevice->handle(), &info, nullptr, &mView), "creating a view");
    if (aspect != kBoth)
        return;
    info.subresourceRange.aspectMask = VK_IMAGE_ASPECT_STENCIL_BIT;
    require(vkCreateImageView(mDevice->handle(), &info, nullptr, &mStencilView), "creating a view");
}

void Image::release() {
    if (!mImage)
        return;
    mDevice->retire([device = mDevice,
                     image = mAdopted ? VK_NULL_HANDLE : mImage,
                     view = mView,
                     stencilView = mStencilView,
                     memory = mMemory,
                     bytes = mMemoryBytes] {
        vkDestroyImageView(device->handle(), view, nullptr);
        vkDestroyImageView(device->handle(), stencilView, nullptr);
        if (!image)
            return;
        vkDestroyImage(device->handle(), image, nullptr);
        --device->living().images;
        freeMemory(*device, memory, bytes);
    });
    mImage = VK_NULL_HANDLE;
}

MemoryBlock::MemoryBlock(Device& device, VkDeviceSize bytes, uint32_t typeBits) : mDevice(&device) {
    VkMemoryRequirements needs{};
    needs.size = bytes;
    needs.memoryTypeBits = typeBits;
    const Allocation allocation = allocate(device, needs, MemoryUse::Device, false, "images");
    mMemory = allocation.memory;
    mMemoryBytes = bytes;
    mType = allocation.type;
}

MemoryBlock::~MemoryBlock() {
    release();
}

MemoryBlock::MemoryBlock(MemoryBlock&& other) noexcept {
    *this = std::move(other);
}

MemoryBlock& MemoryBlock::operator=(MemoryBlock&& other) noexcept {
    if (this == &other)
        return *this;
    release();
    mDevice = std::exchange(other.mDevice, nullptr);
    mMemory = std::exchange(other.mMemory, VK_NULL_HANDLE);
    mMemoryBytes = std::exchange(other.mMemoryBytes, 0);
    mType = other.mType;
    return *this;
}

void MemoryBlock::release() {
    if (!mMemory)
        return;
    mDevice->retire([device = mDevice, memory = mMemory, bytes = mMemoryBytes] {
        freeMemory(*device, memory, bytes);
    });
    mMemory = VK_NULL_HANDLE;
}

} // namespace shutter::gpu
