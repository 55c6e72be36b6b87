// SPDX-License-Identifier: MIT
#include "engine/gpu/memory_blocks.h"

namespace shutter::gpu {

BlockPlan planBlocks(std::span<const VkMemoryRequirements> needs) {
    BlockPlan plan;
    for (const VkMemoryRequirements& need : needs) {
        BlockPlan::Block next;
        if (!plan.blocks.empty())
            next = plan.blocks.back();
        VkDeviceSize offset = (next.bytes + need.alignment - 1) / need.alignment * need.alignment;
        const bool fits =
            offset + need.size <= kBlockBytes && (next.typeBits & need.memoryTypeBits) != 0;
        if (plan.blocks.empty() || !fits) {
            plan.blocks.emplace_back();
            offset = 0;
        }
        BlockPlan::Block& block = plan.blocks.back();
        block.bytes = offset + need.size;
        block.typeBits &= need.memoryTypeBits;
        plan.places.push_back({static_cast<uint32_t>(plan.blocks.size() - 1), offset});
    }
    return plan;
}

} // namespace shutter::gpu
