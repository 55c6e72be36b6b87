// SPDX-License-Identifier: MIT
// Stores a device's compiled pipelines between runs. Drivers trust the blob: one that was damaged
// by a full disk, a crash or another program may crash the driver. So the blob has a checksum and
// is only passed to the driver that made it.
#pragma once

#include "engine/core/result.h"
#include "engine/gpu/vulkan.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <vector>

namespace shutter::gpu {

/// Larger files are not read.
inline constexpr uint64_t kMaxPipelineCacheBytes = uint64_t(256) << 20;

/// The driver in a blob's header.
struct PipelineCacheOwner {
    uint32_t vendorId = 0;
    uint32_t deviceId = 0;
    std::array<uint8_t, VK_UUID_SIZE> uuid{}; ///< VkPhysicalDeviceProperties::pipelineCacheUUID
};

/// The contents of a cache file with `blob`.
[[nodiscard]] std::vector<uint8_t> packPipelineCache(std::span<const uint8_t> blob);

/// The blob in the contents of a file; nothing where another version of this program, or another
/// driver, wrote it. Error: the file is damaged.
[[nodiscard]] core::Result<std::optional<std::span<const uint8_t>>>
unpackPipelineCache(std::span<const uint8_t> file, const PipelineCacheOwner& owner);

/// Returns the blob in `file`; empty if there is no usable one, with a warning if the file is
/// damaged. The cost is only that pipelines are compiled again.
[[nodiscard]] std::vector<uint8_t>
readPipelineCache(const std::filesystem::path& file, const PipelineCacheOwner& owner);

} // namespace shutter::gpu
