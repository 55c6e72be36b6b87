// SPDX-License-Identifier: MIT
// What holds memory of the device: buffers, images, structures, textures and the pool of
// transients, counted while they live; and memory that is not coherent.
#include "engine/gpu/acceleration_structure.h"
#include "engine/gpu/device.h"
#include "engine/gpu/memory.h"
#include "engine/gpu/upload.h"
#include "engine/gpu_scene/texture_table.h"
#include "engine/graph/graph.h"
#include "engine/graph/transient_pool.h"
#include "tests/support/gpu_fixture.h"

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace shutter {
namespace {

using gpu_scene::TextureTable;

/// The device's books of what exists on it: a leak shows there.
class Memory : public test::GpuTest {
  protected:
    void SetUp() override {
        GpuTest::SetUp();
        if (IsSkipped() || HasFatalFailure())
            return;
        settle();
        mBefore = device().living();
    }

    /// Retired objects are freed once the GPU has finished later work.
    static void settle() {
        gpu::runOnce(device(), [](VkCommandBuffer) {});
        device().collectIdle();
    }

    gpu::LivingObjects mBefore;
};

gpu::ImageDesc describeImage() {
    return {64, 32, VK_FORMAT_R16G16B16A16_SFLOAT, VK_IMAGE_USAGE_SAMPLED_BIT};
}

TEST_F(Memory, ABufferCountsWithItsMemoryUntilTheGpuIsDoneWithIt) {
    {
        gpu::Buffer buffer(device(), "buffer", 1000, 0, gpu::MemoryUse::Stream);
        EXPECT_EQ(device().living().buffers, mBefore.buffers + 1);
        EXPECT_EQ(device().living().memoryBlocks, mBefore.memoryBlocks + 1);
        EXPECT_GE(device().living().memoryBytes, mBefore.memoryBytes + 1000);
        const gpu::LivingObjects one = device().living();
        const gpu::Buffer moved = std::move(buffer);
        EXPECT_EQ(device().living(), one) << "moving makes nothing";
    }
    EXPECT_EQ(device().living().buffers, mBefore.buffers + 1) << "retired, not destroyed";
    settle();
    EXPECT_EQ(device().living(), mBefore);
}

TEST_F(Memory, AnImageCountsWithOrWithoutMemoryOfItsOwn) {
    {
        const gpu::Image own(device(), "own", describeImage());
        EXPECT_EQ(device().living().images, mBefore.images + 1);
        EXPECT_EQ(device().living().memoryBlocks, mBefore.memoryBlocks + 1);
        gpu::MemoryBlock block; // goes after the image that lies in it
        gpu::Image placed = gpu::Image::createUnbound(device(), "placed", describeImage());
        const VkMemoryRequirements needs = placed.requirements();
        const gpu::LivingObjects unbound = device().living();
        EXPECT_EQ(unbound.images, mBefore.images + 2);
        EXPECT_EQ(unbound.memoryBlocks, mBefore.memoryBlocks + 1);
        block = gpu::MemoryBlock(device(), needs.size, needs.memoryTypeBits);
        EXPECT_EQ(device().living().memoryBytes, unbound.memoryBytes + needs.size);
        placed.bind(block.handle(), 0);
        EXPECT_EQ(device().living().memoryBlocks, mBefore.memoryBlocks + 2);
    }
    settle();
    EXPECT_EQ(device().living(), mBefore);
}

TEST_F(Memory, AnAccelerationStructureCountsWithItsBuffer) {
    if (!device().hasRays())
        GTEST_SKIP() << "the device has no rays";
    {
        gpu::AccelerationStructure structure(
            device(), "level", VK_ACCELERATION_STRUCTURE_TYPE_TOP_LEVEL_KHR, 4096
        );
        EXPECT_EQ(device().living().accelerationStructures, mBefore.accelerationStructures + 1);
        EXPECT_EQ(device().living().buffers, mBefore.buffers + 1);
        structure = {};
    }
    settle();
    EXPECT_EQ(device().living(), mBefore);
}

std::vector<uint32_t> copyValues(const gpu::Buffer& buffer) {
    const auto* values = static_cast<const uint32_t*>(buffer.mapped());
    return {values, values + 4};
}

TEST_F(Memory, NonCoherentMemoryIsFlushedAndInvalidated) {
    gpu::DeviceOptions options;
    options.validate = true;
    auto opened = test::openFaulty(options, "SHUTTER_FAULT_HIDE", "hostCoherent");
    ASSERT_TRUE(opened.ok()) << opened.error().message;
    const std::unique_ptr<gpu::Device> incoherent = std::move(opened).value();
    {
        gpu::Buffer source(*incoherent, "source", 16, 0, gpu::MemoryUse::Readback);
        gpu::Buffer target(*incoherent, "target", 16, 0, gpu::MemoryUse::Readback);
        const std::vector<uint32_t> values{1, 2, 3, 4};
        source.write(std::span(values));
        target.writeZeros();
        EXPECT_EQ(copyValues(target), std::vector<uint32_t>(4, 0));
        gpu::runOnce(*incoherent, [&](VkCommandBuffer commands) {
            const VkBufferCopy region{0, 0, 16};
            vkCmdCopyBuffer(commands, source.handle(), target.handle(), 1, &region);
        });
        EXPECT_EQ(copyValues(target), values);
    }
    EXPECT_THROW(gpu::Buffer(*incoherent, "table", 16, 0, gpu::MemoryUse::Stream), gpu::DeviceError)
        << "no device lacks coherent memory; one without it gets a sentence";
    incoherent->collectIdle();
    EXPECT_EQ(incoherent->living(), gpu::LivingObjects{}) << "what failed leaves nothing behind";
    EXPECT_EQ(incoherent->validationMessageCount(), 0u);
}

/// Textures of separate images, which alternate between two wrap modes.
scene::Assets makeAssets(uint32_t textureCount) {
    scene::Assets assets;
    for (uint32_t i = 0; i < textureCount; ++i) {
        assets.images.push_back({"image " + std::to_string(i), 4, 4, std::vector<uint8_t>(64, 200)}
        );
        scene::Texture texture;
        texture.image = i;
        texture.wrapU = i % 2 == 0 ? scene::Wrap::Repeat : scene::Wrap::ClampToEdge;
        assets.textures.push_back(texture);
    }
    return assets;
}

TEST_F(Memory, ManyTexturesShareBlocksOfMemoryAndSamplers) {
    if (gpu_scene::findTextureLimit(device().limits()).count < 240)
        GTEST_SKIP() << device().info().name << " takes fewer textures";
    const scene::Assets assets = makeAssets(120);
    const uint64_t allocations = device().allocationCount();
    const uint64_t submissions = device().completedValue();
    {
        const TextureTable table(device(), assets, std::vector<bool>(240, true));
        EXPECT_NE(table.set(), VkDescriptorSet{VK_NULL_HANDLE});
        EXPECT_EQ(device().living().images, mBefore.images + 240);
        EXPECT_EQ(device().living().samplers, mBefore.samplers + 2);
        // One that stays, and one for staging.
        EXPECT_EQ(device().allocationCount(), allocations + 2);
        EXPECT_EQ(device().completedValue(), submissions + 1);
        device().collectIdle();
        EXPECT_EQ(device().living().memoryBlocks, mBefore.memoryBlocks + 1);
    }
    device().collectIdle();
    EXPECT_EQ(device().living(), mBefore);
}

TEST_F(Memory, AnImageThatSeveralTexturesShowIsUploadedOnce) {
    const TextureTable none(device(), {}, {});
    EXPECT_NE(none.layout(), VkDescriptorSetLayout{VK_NULL_HANDLE});
    mBefore = device().living();
    scene::Assets assets = makeAssets(4);
    for (scene::Texture& texture : assets.textures)
        texture.image = 1;
    const TextureTable table(
        device(), assets, {true, false, true, true, false, false, true, false}
    );
    EXPECT_EQ(device().living().images, mBefore.images + 2) << "as sRGB and linear";
}

TEST(TextureLimit, TheSmallestLimitCountsLessWhatPassesBind) {
    VkPhysicalDeviceLimits limits{};
    limits.maxPerStageResources = 5000;
    limits.maxPerStageDescriptorSamplers = 4000;
    limits.maxPerStageDescriptorSampledImages = 1016;
    limits.maxDescriptorSetSamplers = 4000;
    limits.maxDescriptorSetSampledImages = 4000;
    EXPECT_EQ(gpu_scene::findTextureLimit(limits).count, 1000u);
    EXPECT_STREQ(gpu_scene::findTextureLimit(limits).name, "maxPerStageDescriptorSampledImages");
    limits.maxDescriptorSetSamplers = 7;
    EXPECT_EQ(gpu_scene::findTextureLimit(limits).count, 0u);
    EXPECT_STREQ(gpu_scene::findTextureLimit(limits).name, "maxDescriptorSetSamplers");
}

/// A plan of some images, one after the other in a block, and a buffer where `bytes` is not 0.
struct MadePlan {
    graph::Graph graph;
    graph::Plan plan;
};

MadePlan makePlan(graph::TransientPool& pool, uint32_t imageCount, VkDeviceSize bytes) {
    MadePlan made;
    const auto findNeeds = pool.requirementFunction();
    for (uint32_t i = 0; i < imageCount; ++i) {
        const graph::TransientImageDesc desc{256, 256, VK_FORMAT_R16G16B16A16_SFLOAT};
        const auto image = made.graph.createImage("image " + std::to_string(i), desc);
        graph::Placement placement;
        placement.resource = image.resource;
        placement.imageUsage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
        const auto needed = findNeeds(desc, placement.imageUsage);
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

class TransientPool : public Memory {
  protected:
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
    {
        graph::TransientPool pool(device());
        realize(pool, 1, 0);
        const VkDeviceSize one = pool.heldBytes();
        realize(pool, 5, 0);
        EXPECT_EQ(pool.heldBytes(), 5 * one);
        realize(pool, 3, 0);
        EXPECT_EQ(pool.heldBytes(), 5 * one);
        EXPECT_EQ(device().living().memoryBlocks, mBefore.memoryBlocks + 1);
        pool.clear();
        EXPECT_EQ(pool.heldBytes(), 0u);
    }
    device().collectIdle();
    EXPECT_EQ(device().living(), mBefore);
}

TEST_F(TransientPool, ImagesOfAnotherSizeAreFreed) {
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
