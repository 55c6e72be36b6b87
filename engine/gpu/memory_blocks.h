// SPDX-License-Identifier: MIT
// Many things in few allocations: devices guarantee 4096 of these, and drivers round each up.
#pragma once

#include "engine/gpu/vulkan.h"

#include <cstdint>
#include <span>
#include <vector>

namespace shutter::gpu {

/// Most bytes of a block that holds several things.
inline constexpr VkDeviceSize kBlockBytes = VkDeviceSize(128) << 20;

/// Where things lie in blocks that are made for them.
struct BlockPlan {
    struct Place {
        uint32_t block = 0;
        VkDeviceSize offset = 0;

        bool operator==(const Place&) const = default;
    };

    struct Block {
        VkDeviceSize bytes = 0;
        uint32_t typeBits = UINT32_MAX; ///< memory types that all of its things take

        bool operator==(const Block&) const = default;
    };

    std::vector<Place> places; ///< one per item, in order
    std::vector<Block> blocks;
};

/// Places items in sequence, each at its alignment; starts a new block where the last would exceed
/// kBlockBytes or where no memory type suits all items in it. Larger items get a block each.
[[nodiscard]] BlockPlan planBlocks(std::span<const VkMemoryRequirements> needs);

} // namespace shutter::gpu
