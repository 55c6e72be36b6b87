// SPDX-License-Identifier: MIT
#include "engine/gpu/upload.h"

#include "engine/core/check.h"

#include <algorithm>
#include <bit>

namespace shutter::gpu {

namespace {

void transition(
    VkCommandBuffer commands, VkImage image, uint32_t mip, VkImageLayout from, VkImageLayout to
) {
    VkImageMemoryBarrier2 barrier{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2};
    barrier.srcStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    barrier.srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT;
    barrier.dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    barrier.dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
    barrier.oldLayout = from;
    barrier.newLayout = to;
    barrier.image = image;
    barrier.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, mip, 1, 0, 1};
    VkDependencyInfo info{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
    info.imageMemoryBarrierCount = 1;
    info.pImageMemoryBarriers = &barrier;
    vkCmdPipelineBarrier2(commands, &info);
}

/// An extent at a mip level, at least 1.
int32_t shrink(uint32_t extent, uint32_t mip) {
    return static_cast<int32_t>(std::max(extent >> mip, 1u));
}

/// Fills the levels above 0 and leaves all in SHADER_READ_ONLY_OPTIMAL. Level 0 is in
/// TRANSFER_DST_OPTIMAL before.
void buildMipLevels(VkCommandBuffer commands, const Image& target) {
    const ImageDesc& desc = target.desc();
    const VkImage image = target.handle();
    for (uint32_t mip = 1; mip < desc.mipLevels; ++mip) {
        transition(
            commands,
            image,
            mip - 1,
            VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
            VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL
        );
        transition(
            commands, image, mip, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL
        );
        VkImageBlit blit{};
        blit.srcSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, mip - 1, 0, 1};
        blit.srcOffsets[1] = {shrink(desc.width, mip - 1), shrink(desc.height, mip - 1), 1};
        blit.dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, mip, 0, 1};
        blit.dstOffsets[1] = {shrink(desc.width, mip), shrink(desc.height, mip), 1};
        vkCmdBlitImage(
            commands,
            image,
            VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
            image,
            VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
            1,
            &blit,
            VK_FILTER_LINEAR
        );
    }
    for (uint32_t mip = 0; mip < desc.mipLevels; ++mip)
        transition(
            commands,
            image,
            mip,
            mip + 1 < desc.mipLevels ? VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL
                                     : VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
            VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL
        );
}

/// A pool for one submission, whatever becomes of it.
class TransferPool {
  public:
    explicit TransferPool(Device& device) : mDevice(device) {
        VkCommandPoolCreateInfo info{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
        info.queueFamilyIndex = device.queueFamily();
        require(
            vkCreateCommandPool(device.handle(), &info, nullptr, &mPool), "starting a transfer"
        );
    }

    ~TransferPool() { vkDestroyCommandPool(mDevice.handle(), mPool, nullptr); }

    TransferPool(const TransferPool&) = delete;
    TransferPool& operator=(const TransferPool&) = delete;

    [[nodiscard]] VkCommandPool handle() const { return mPool; }

  private:
    Device& mDevice;
    VkCommandPool mPool = VK_NULL_HANDLE;
};

} // namespace

void fullBarrier(VkCommandBuffer commands) {
    VkMemoryBarrier2 barrier{VK_STRUCTURE_TYPE_MEMORY_BARRIER_2};
    barrier.srcStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    barrier.srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT;
    barrier.dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    barrier.dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
    VkDependencyInfo info{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
    info.memoryBarrierCount = 1;
    info.pMemoryBarriers = &barrier;
    vkCmdPipelineBarrier2(commands, &info);
}

void runOnce(Device& device, const std::function<void(VkCommandBuffer)>& record) {
    const TransferPool pool(device);
    VkCommandBufferAllocateInfo allocate{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
    allocate.commandPool = pool.handle();
    allocate.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
    allocate.commandBufferCount = 1;
    VkCommandBuffer commands = VK_NULL_HANDLE;
    require(vkAllocateCommandBuffers(device.handle(), &allocate, &commands), "starting a transfer");
    VkCommandBufferBeginInfo begin{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    require(vkBeginCommandBuffer(commands, &begin), "starting a transfer");
    record(commands);
    fullBarrier(commands);
    require(vkEndCommandBuffer(commands), "ending a transfer");
    device.wait(device.submit(std::span(&commands, 1)));
}

std::vector<UploadPart> splitUpload(VkDeviceSize total, VkDeviceSize unit) {
    SHUTTER_CHECK(unit > 0 && total % unit == 0, "{} bytes in units of {}", total, unit);
    const VkDeviceSize most = std::max(kStagingBytes / unit, VkDeviceSize(1)) * unit;
    std::vector<UploadPart> parts;
    for (VkDeviceSize offset = 0; offset < total; offset += most)
        parts.push_back({offset, std::min(most, total - offset)});
    return parts;
}

void uploadBuffer(
    Device& device, Buffer& target, std::span<const std::byte> data, VkDeviceSize offset
) {
    if (data.empty())
        return;
    SHUTTER_CHECK(offset + data.size() <= target.bytes(), "upload past the end of a buffer");
    const auto parts = splitUpload(data.size(), 1);
    Buffer staging(device, "staging", parts.front().bytes, 0, MemoryUse::Staging);
    for (const UploadPart& part : parts) {
        staging.write(data.subspan(part.offset, part.bytes));
        runOnce(device, [&](VkCommandBuffer commands) {
            const VkBufferCopy region{0, offset + part.offset, part.bytes};
            vkCmdCopyBuffer(commands, staging.handle(), target.handle(), 1, &region);
        });
    }
}

uint32_t countMipLevels(uint32_t width, uint32_t height) {
    return static_cast<uint32_t>(std::bit_width(std::max({width, height, 1u})));
}

namespace {

/// Rows of a level of a texture that wait in the staging buffer.
struct StagedRows {
    const Image* target = nullptr;
    uint32_t mip = 0;
    bool buildsMips = false; ///< once they are there, of the level the others
    VkDeviceSize offset = 0; ///< in the staging buffer
    uint32_t firstRow = 0;
    uint32_t rowCount = 0;
};

/// Offsets of copies are multiples of a texel; this is one of all of them.
constexpr VkDeviceSize kStagedAlignment = 16;

/// A staging buffer that many textures share, so that they share submissions.
class TextureStaging {
  public:
    TextureStaging(Device& device, VkDeviceSize bytes)
        : mDevice(device), mBuffer(device, "staging", bytes, 0, MemoryUse::Staging) {}

    /// \param buildsMips the levels above are made of this one
    void
    add(const Image& target, uint32_t mip, std::span<const std::byte> texels, bool buildsMips) {
        const ImageDesc& desc = target.desc();
        const auto height = static_cast<uint32_t>(shrink(desc.height, mip));
        const VkDeviceSize rowBytes =
            VkDeviceSize(shrink(desc.width, mip)) * texelBytes(desc.format);
        for (uint32_t row = 0; row < height;) {
            const VkDeviceSize free = mBuffer.bytes() - std::min(mUsed, mBuffer.bytes());
            const auto rows =
                static_cast<uint32_t>(std::min<VkDeviceSize>(free / rowBytes, height - row));
            if (rows == 0) {
                flush();
                continue;
            }
            mBuffer.writeBytes(texels.data() + row * rowBytes, rows * rowBytes, mUsed);
            mStaged.push_back({&target, mip, buildsMips, mUsed, row, rows});
            mUsed = (mUsed + rows * rowBytes + kStagedAlignment - 1) / kStagedAlignment *
                    kStagedAlignment;
            row += rows;
        }
    }

    /// Copies the added data and waits.
    void flush() {
        runOnce(mDevice, [&](VkCommandBuffer commands) {
            for (const StagedRows& rows : mStaged)
                record(commands, rows);
        });
        mStaged.clear();
        mUsed = 0;
    }

  private:
    void record(VkCommandBuffer commands, const StagedRows& rows) const {
        const ImageDesc& desc = rows.target->desc();
        const auto height = static_cast<uint32_t>(shrink(desc.height, rows.mip));
        if (rows.firstRow == 0)
            transition(
                commands,
                rows.target->handle(),
                rows.mip,
                VK_IMAGE_LAYOUT_UNDEFINED,
                VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL
            );
        VkBufferImageCopy region{};
        region.bufferOffset = rows.offset;
        region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, rows.mip, 0, 1};
        region.imageOffset.y = static_cast<int32_t>(rows.firstRow);
        region.imageExtent = {
            static_cast<uint32_t>(shrink(desc.width, rows.mip)), rows.rowCount, 1};
        vkCmdCopyBufferToImage(
            commands,
            mBuffer.handle(),
            rows.target->handle(),
            VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
            1,
            &region
        );
        if (rows.firstRow + rows.rowCount < height)
            return;
        if (rows.buildsMips)
            buildMipLevels(commands, *rows.target);
        else
            transition(
                commands,
                rows.target->handle(),
                rows.mip,
                VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL
            );
    }

    Device& mDevice;
    Buffer mBuffer;
    VkDeviceSize mUsed = 0; ///< of the buffer
    std::vector<StagedRows> mStaged;
};

} // namespace

void uploadTextures(Device& device, std::span<const TextureUpload> uploads) {
    VkDeviceSize total = 0;
    VkDeviceSize longestRow = 0;
    for (const TextureUpload& upload : uploads) {
        const ImageDesc& desc = upload.target->desc();
        const VkDeviceSize rowBytes = VkDeviceSize(desc.width) * texelBytes(desc.format);
        SHUTTER_CHECK_EQ(upload.texels.size(), size_t(rowBytes * desc.height));
        total += upload.texels.size() + kStagedAlignment;
        longestRow = std::max(longestRow, rowBytes);
    }
    if (uploads.empty())
        return;
    TextureStaging staging(device, std::max(longestRow, std::min(total, kStagingBytes)));
    for (const TextureUpload& upload : uploads)
        staging.add(*upload.target, 0, upload.texels, /*buildsMips=*/true);
    staging.flush();
}

void uploadLevels(
    Device& device, const Image& target, std::span<const std::span<const std::byte>> levels
) {
    const ImageDesc& desc = target.desc();
    SHUTTER_CHECK_EQ(levels.size(), size_t(desc.mipLevels));
    VkDeviceSize total = 0;
    for (uint32_t mip = 0; mip < desc.mipLevels; ++mip) {
        SHUTTER_CHECK_EQ(
            levels[mip].size(),
            size_t(shrink(desc.width, mip)) * size_t(shrink(desc.height, mip)) *
                texelBytes(desc.format)
        );
        total += levels[mip].size() + kStagedAlignment;
    }
    const VkDeviceSize rowBytes = VkDeviceSize(desc.width) * texelBytes(desc.format);
    TextureStaging staging(device, std::max(rowBytes, std::min(total, kStagingBytes)));
    for (uint32_t mip = 0; mip < desc.mipLevels; ++mip)
        staging.add(target, mip, levels[mip], /*buildsMips=*/false);
    staging.flush();
}

void uploadTexture(Device& device, Image& target, std::span<const std::byte> texels) {
    const TextureUpload upload{&target, texels};
    uploadTextures(device, std::span(&upload, 1));
}

} // namespace shutter::gpu
