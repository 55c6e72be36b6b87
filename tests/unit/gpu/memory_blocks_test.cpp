// SPDX-License-Identifier: MIT
#include "engine/gpu/memory_blocks.h"

#include <gtest/gtest.h>

#include <vector>

namespace shutter::gpu {
namespace {

using Place = BlockPlan::Place;
using Block = BlockPlan::Block;

TEST(MemoryBlocks, ThingsLieOneAfterAnotherAtTheirAlignment) {
    const std::vector<VkMemoryRequirements> needs{{100, 16, 7}, {10, 64, 3}, {1, 1, 7}};
    const BlockPlan plan = planBlocks(needs);
    EXPECT_EQ(plan.places, (std::vector<Place>{{0, 0}, {0, 128}, {0, 138}}));
    EXPECT_EQ(plan.blocks, (std::vector<Block>{{139, 3}}));
}

TEST(MemoryBlocks, AFullBlockAndAnotherKindOfMemoryStartAnother) {
    const std::vector<VkMemoryRequirements> needs{
        {kBlockBytes - 1, 1, 1},
        {1, 1, 1},
        {1, 1, 1},
        {5, 1, 2},
        {2 * kBlockBytes, 1, 2},
        {1, 1, 2}};
    const BlockPlan plan = planBlocks(needs);
    EXPECT_EQ(
        plan.places,
        (std::vector<Place>{{0, 0}, {0, kBlockBytes - 1}, {1, 0}, {2, 0}, {3, 0}, {4, 0}})
    );
    EXPECT_EQ(plan.blocks[3], (Block{2 * kBlockBytes, 2})) << "a larger item has a separate block";
}

TEST(MemoryBlocks, AScenesThousandsOfTexturesNeedFewAllocations) {
    // Pictures of 256 x 256 with their levels.
    const std::vector<VkMemoryRequirements> needs(5000, {350000, 65536, 1});
    EXPECT_LT(planBlocks(needs).blocks.size(), 20u);
    EXPECT_TRUE(planBlocks({}).blocks.empty());
}

} // namespace
} // namespace shutter::gpu
