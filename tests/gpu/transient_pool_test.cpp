// SPDX-License-Identifier: MIT
// What the pool of transients keeps when plans change.
#include "engine/graph/graph.h"
#include "engine/graph/transient_pool.h"
#include "tests/support/gpu_fixture.h"

#include <cstdint>
#include <string>

namespace shutter {
namespace {

constexpr uint32_t kSize = 256;

/// A plan of some images, one after the other in a block, and a buffer where `bytes` is not 0.
struct MadePlan {
    graph::Graph graph;
    graph::Plan plan;
};

MadePlan makePlan(graph::TransientPool& pool, uint32_t imageCount, VkDeviceSize bytes) {
    MadePlan made;
    const auto ask = pool.requirementFunction();
    for (uint32_t i = 0; i < imageCount; ++i) {
        graph::TransientImageDesc desc;
        desc.width = kSize;
        desc.height = kSize;
        desc.format = VK_FORMAT_R16G16B16A16_SFLOAT;
        const auto image = made.graph.createImage("image " + std::to_string(i), desc);
        graph::Placement placement;
        placement.resource = image.resource;
        placement.imageUsage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
        const auto needed = ask(desc, placement.imageUsage);
        placement.bytes = needed.bytes;
        placement.offset = made.plan.blockBytes;
        made.plan.blockBytes += needed.bytes;
        made.plan.images.push_back(placement);
    }
    if (bytes > 0) {
        const auto buffer = made.graph.createBuffer("buffer", {bytes});
        graph::Placement placement;
        placement.resource = buffer.resource;
        placement.bytes = bytes;
        placement.bufferUsage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
        made.plan.buffers.push_back(placement);
    }
    return made;
}

class TransientPool : public test::GpuTest {
  protected:
    void SetUp() override {
        GpuTest::SetUp();
        if (!IsSkipped() && !HasFatalFailure())
            device().collectIdle(); // what other tests left
    }

    void realize(graph::TransientPool& pool, uint32_t imageCount, VkDeviceSize bytes) {
        const MadePlan made = makePlan(pool, imageCount, bytes);
        pool.realize(made.graph, made.plan);
        for (const graph::Placement& image : made.plan.images)
            EXPECT_NE(pool.image(image.resource), nullptr);
        for (const graph::Placement& buffer : made.plan.buffers)
            EXPECT_NE(pool.buffer(buffer.resource), nullptr);
        device().collectIdle();
    }
};

TEST_F(TransientPool, MotionThatStopsAndStartsAllocatesOnce) {
    graph::TransientPool pool(device());
    realize(pool, 2, 0);
    realize(pool, 9, 4096);
    const uint64_t allocations = device().allocationCount();
    const gpu::LivingObjects living = device().living();
    for (int i = 0; i < 20; ++i)
        realize(pool, i % 2 == 0 ? 2 : 9, i % 2 == 0 ? 0 : 4096);
    EXPECT_EQ(device().allocationCount(), allocations);
    EXPECT_EQ(device().living(), living);
}

TEST_F(TransientPool, TheBlockGrowsAndIsGivenBackWhole) {
    const gpu::LivingObjects before = device().living();
    {
        graph::TransientPool pool(device());
        realize(pool, 1, 0);
        const VkDeviceSize one = pool.heldBytes();
        realize(pool, 5, 0);
        EXPECT_EQ(pool.heldBytes(), 5 * one);
        realize(pool, 3, 0);
        EXPECT_EQ(pool.heldBytes(), 5 * one);
        EXPECT_EQ(device().living().memoryBlocks, before.memoryBlocks + 1);
        pool.clear();
        EXPECT_EQ(pool.heldBytes(), 0u);
    }
    device().collectIdle();
    EXPECT_EQ(device().living(), before);
}

TEST_F(TransientPool, NothingIsKeptForPicturesOfAnotherSize) {
    graph::TransientPool pool(device());
    pool.keepFor(640, 360);
    realize(pool, 5, 4096);
    pool.keepFor(640, 360);
    EXPECT_GT(pool.heldBytes(), 0u);
    pool.keepFor(640, 361);
    EXPECT_EQ(pool.heldBytes(), 0u);
}

TEST_F(TransientPool, IdleBuffersTakeNoMoreThanTheLargestPlanUsed) {
    graph::TransientPool pool(device());
    for (VkDeviceSize bytes = 1000; bytes <= 20000; bytes += 1000)
        realize(pool, 0, bytes);
    EXPECT_LE(pool.heldBytes(), 2u * 20000u);
}

} // namespace
} // namespace shutter
