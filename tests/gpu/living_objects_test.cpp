// SPDX-License-Identifier: MIT
// The device's books of what exists on it: a leak shows there.
#include "engine/gpu/acceleration_structure.h"
#include "engine/gpu/memory.h"
#include "engine/gpu/upload.h"
#include "tests/support/gpu_fixture.h"

#include <utility>

namespace shutter {
namespace {

class LivingObjects : public test::GpuTest {
  protected:
    void SetUp() override {
        GpuTest::SetUp();
        if (!IsSkipped())
            settle();
    }

    /// What is retired goes once the GPU has done something after it.
    static void settle() {
        gpu::Device& with = device();
        with.waitIdle();
        gpu::runOnce(with, [](VkCommandBuffer) {});
        with.waitIdle();
        with.collect();
    }

    static gpu::ImageDesc describeImage() {
        gpu::ImageDesc desc;
        desc.width = 64;
        desc.height = 32;
        desc.format = VK_FORMAT_R16G16B16A16_SFLOAT;
        desc.usage = VK_IMAGE_USAGE_SAMPLED_BIT;
        return desc;
    }
};

TEST_F(LivingObjects, ABufferCountsWithItsMemoryUntilTheGpuIsDoneWithIt) {
    const gpu::LivingObjects before = device().living();
    {
        gpu::Buffer buffer(device(), "buffer", 1000, 0, gpu::MemoryUse::Stream);
        EXPECT_EQ(device().living().buffers, before.buffers + 1);
        EXPECT_EQ(device().living().memoryBlocks, before.memoryBlocks + 1);
        EXPECT_GE(device().living().memoryBytes, before.memoryBytes + 1000);
        const gpu::LivingObjects one = device().living();
        const gpu::Buffer moved = std::move(buffer);
        EXPECT_EQ(device().living(), one) << "moving makes nothing";
    }
    EXPECT_EQ(device().living().buffers, before.buffers + 1) << "retired, not destroyed";
    settle();
    EXPECT_EQ(device().living(), before);
}

TEST_F(LivingObjects, AnImageCountsWithOrWithoutMemoryOfItsOwn) {
    const gpu::LivingObjects before = device().living();
    {
        const gpu::Image own(device(), "own", describeImage());
        EXPECT_EQ(device().living().images, before.images + 1);
        EXPECT_EQ(device().living().memoryBlocks, before.memoryBlocks + 1);
        gpu::MemoryBlock block; // goes after the image that lies in it
        gpu::Image placed = gpu::Image::createUnbound(device(), "placed", describeImage());
        const VkMemoryRequirements needs = placed.requirements();
        const gpu::LivingObjects unbound = device().living();
        EXPECT_EQ(unbound.images, before.images + 2);
        EXPECT_EQ(unbound.memoryBlocks, before.memoryBlocks + 1);
        block = gpu::MemoryBlock(device(), needs.size, needs.memoryTypeBits);
        EXPECT_EQ(device().living().memoryBytes, unbound.memoryBytes + needs.size);
        placed.bind(block.handle(), 0);
        EXPECT_EQ(device().living().memoryBlocks, before.memoryBlocks + 2);
    }
    settle();
    EXPECT_EQ(device().living(), before);
}

TEST_F(LivingObjects, AnAccelerationStructureCountsWithItsBuffer) {
    if (!device().hasRays())
        GTEST_SKIP() << "the device has no rays";
    const gpu::LivingObjects before = device().living();
    {
        gpu::AccelerationStructure structure(
            device(), "level", VK_ACCELERATION_STRUCTURE_TYPE_TOP_LEVEL_KHR, 4096
        );
        EXPECT_EQ(device().living().accelerationStructures, before.accelerationStructures + 1);
        EXPECT_EQ(device().living().buffers, before.buffers + 1);
        structure = {};
    }
    settle();
    EXPECT_EQ(device().living(), before);
}

} // namespace
} // namespace shutter
