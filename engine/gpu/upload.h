// SPDX-License-Identifier: MIT
// One-off transfers at load and readback at the end. Each call submits and waits: never in a frame.
#pragma once

#include "engine/gpu/device.h"
#include "engine/gpu/memory.h"

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

namespace shutter::gpu {

/// Records with `record`, submits, waits.
void runOnce(Device& device, const std::function<void(VkCommandBuffer)>& record);

/// Most bytes that are staged at once; larger transfers go in parts, so that a scene of gigabytes
/// needs no second copy of itself in mapped memory.
inline constexpr VkDeviceSize kStagingBytes = VkDeviceSize(32) << 20;

/// A part of a transfer.
struct UploadPart {
    VkDeviceSize offset = 0;
    VkDeviceSize bytes = 0;

    bool operator==(const UploadPart&) const = default;
};

/// The parts of a transfer of `total` bytes: of whole units each, as many as kStagingBytes holds
/// and at least one. \param unit bytes that are not split (a row of a picture); divides `total`
[[nodiscard]] std::vector<UploadPart> splitUpload(VkDeviceSize total, VkDeviceSize unit);

/// Fills a device buffer through staging memory.
void uploadBuffer(
    Device& device, Buffer& target, std::span<const std::byte> data, VkDeviceSize offset = 0
);

/// Fills mip 0 with `texels` (tightly packed) and the others by successive halving with a linear
/// filter (in linear light for sRGB formats). Leaves the image in SHADER_READ_ONLY_OPTIMAL.
void uploadTexture(Device& device, Image& target, std::span<const std::byte> texels);

struct TextureUpload {
    const Image* target = nullptr;
    std::span<const std::byte> texels; ///< of mip 0, tightly packed
};

/// The same for many, which share submissions of kStagingBytes each.
void uploadTextures(Device& device, std::span<const TextureUpload> uploads);

/// Fills every mip level with its own texels (tightly packed), as many as the image has (CHECKed).
/// Leaves the image in SHADER_READ_ONLY_OPTIMAL.
void uploadLevels(
    Device& device, const Image& target, std::span<const std::span<const std::byte>> levels
);

/// Mip levels of a full chain.
[[nodiscard]] uint32_t countMipLevels(uint32_t width, uint32_t height);

/// A full-frame memory barrier (everything before, everything after), for the helpers here and for
/// acceleration structure builds outside the render graph.
void fullBarrier(VkCommandBuffer commands);

} // namespace shutter::gpu
