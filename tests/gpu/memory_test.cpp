// SPDX-License-Identifier: MIT
// What holds memory of the device: buffers, images, structures, textures and the pool of
// transients, counted while they live; memory that is not coherent; and uploads, read back:
// textures with their mip levels, buffers, and pictures of window formats, which are read as shown.
#include "engine/gpu/acceleration_structure.h"
#include "engine/gpu/device.h"
#include "engine/gpu/memory.h"
#include "engine/gpu/upload.h"
#include "engine/gpu_scene/texture_table.h"
#include "engine/graph/graph.h"
#include "engine/graph/transient_pool.h"
#include "tests/gpu/effect_rig.h"
#include "tests/gpu/other_device.h"
#include "tests/support/gpu_fixture.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <deque>
#include <numeric>
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

    void TearDown() override {
        if (!IsSkipped() && !HasFatalFailure()) {
            settle();
            EXPECT_EQ(device().living(), mBefore) << "something is left";
        }
        GpuTest::TearDown();
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
}

TEST_F(Memory, AnImageCountsWithOrWithoutMemoryOfItsOwn) {
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

TEST_F(Memory, AnAccelerationStructureCountsWithItsBuffer) {
    if (!device().hasRays())
        GTEST_SKIP() << "the device has no rays";
    const gpu::AccelerationStructure structure(
        device(), "level", VK_ACCELERATION_STRUCTURE_TYPE_TOP_LEVEL_KHR, 4096
    );
    EXPECT_EQ(device().living().accelerationStructures, mBefore.accelerationStructures + 1);
    EXPECT_EQ(device().living().buffers, mBefore.buffers + 1);
}

std::vector<uint32_t> copyValues(const gpu::Buffer& buffer) {
    const auto* values = static_cast<const uint32_t*>(buffer.mapped());
    return {values, values + 4};
}

using IncoherentMemory = test::OtherDeviceTest;

TEST_F(IncoherentMemory, WritesAreFlushedAndReadsInvalidated) {
    open({}, "hostCoherent");
    {
        gpu::Buffer source(*mOther, "source", 16, 0, gpu::MemoryUse::Readback);
        gpu::Buffer target(*mOther, "target", 16, 0, gpu::MemoryUse::Readback);
        const std::vector<uint32_t> values{1, 2, 3, 4};
        source.write(std::span(values));
        target.writeZeros();
        EXPECT_EQ(copyValues(target), std::vector<uint32_t>(4, 0));
        gpu::runOnce(*mOther, [&](VkCommandBuffer commands) {
            const VkBufferCopy region{0, 0, 16};
            vkCmdCopyBuffer(commands, source.handle(), target.handle(), 1, &region);
        });
        EXPECT_EQ(copyValues(target), values);
    }
    EXPECT_THROW(gpu::Buffer(*mOther, "table", 16, 0, gpu::MemoryUse::Stream), gpu::DeviceError)
        << "no device lacks coherent memory; one without it gets a sentence";
    mOther->collectIdle();
    EXPECT_EQ(mOther->living(), gpu::LivingObjects{}) << "what failed leaves nothing behind";
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

TEST_F(Memory, AnImageThatSeveralTexturesShowIsUploadedOnce) {
    const TextureTable none(device(), {}, {});
    EXPECT_NE(none.layout(), VkDescriptorSetLayout{VK_NULL_HANDLE});
    const gpu::LivingObjects before = device().living();
    scene::Assets assets = makeAssets(4);
    for (scene::Texture& texture : assets.textures)
        texture.image = 1;
    const TextureTable table(
        device(), assets, {true, false, true, true, false, false, true, false}
    );
    EXPECT_EQ(device().living().images, before.images + 2) << "as sRGB and linear";
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

TEST_F(TransientPool, OldMemoryIsFreedBeforeMoreIsTaken) {
    graph::TransientPool pool(device());
    pool.keepFor(640, 360);
    for (const uint32_t count : {1u, 5u}) {
        const MadePlan made = makePlan(pool, count, 0);
        pool.realize(made.graph, made.plan);
        EXPECT_EQ(device().living().memoryBlocks, mBefore.memoryBlocks + 1) << count;
    }
    pool.keepFor(640, 361);
    EXPECT_EQ(device().living().memoryBlocks, mBefore.memoryBlocks);
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

class Upload : public test::GpuTest {};

using Texels = std::vector<uint8_t>; // RGBA8

gpu::Image makeImage(
    gpu::Device& device, uint32_t width, uint32_t height, VkFormat format, bool hasLevels = true
) {
    gpu::ImageDesc desc{width, height, format};
    desc.mipLevels = hasLevels ? gpu::countMipLevels(width, height) : 1;
    desc.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT |
                 VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    return {device, "texture", desc};
}

gpu::Image makeTexture(
    gpu::Device& device, uint32_t width, uint32_t height, VkFormat format, const Texels& texels
) {
    gpu::Image image = makeImage(device, width, height, format);
    gpu::uploadTexture(device, image, std::as_bytes(std::span(texels)));
    return image;
}

Texels readLevel(gpu::Device& device, const gpu::Image& image, uint32_t level) {
    const uint32_t width = std::max(image.desc().width >> level, 1u);
    const uint32_t height = std::max(image.desc().height >> level, 1u);
    gpu::Buffer buffer(
        device, "level", VkDeviceSize(width) * height * 4, 0, gpu::MemoryUse::Readback
    );
    gpu::runOnce(device, [&](VkCommandBuffer commands) {
        VkImageMemoryBarrier2 barrier{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2};
        barrier.srcStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
        barrier.srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT;
        barrier.dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
        barrier.dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT;
        barrier.oldLayout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
        barrier.newLayout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
        barrier.image = image.handle();
        barrier.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, level, 1, 0, 1};
        VkDependencyInfo dependency{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
        dependency.imageMemoryBarrierCount = 1;
        dependency.pImageMemoryBarriers = &barrier;
        vkCmdPipelineBarrier2(commands, &dependency);
        VkBufferImageCopy region{};
        region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, level, 0, 1};
        region.imageExtent = {width, height, 1};
        vkCmdCopyImageToBuffer(
            commands,
            image.handle(),
            VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
            buffer.handle(),
            1,
            &region
        );
    });
    const auto* bytes = static_cast<const uint8_t*>(buffer.mapped());
    return {bytes, bytes + size_t(width) * height * 4};
}

Texels makePattern(uint32_t width, uint32_t height) {
    Texels texels;
    for (uint32_t i = 0; i < width * height; ++i)
        for (uint32_t c = 0; c < 4; ++c)
            texels.push_back(static_cast<uint8_t>((i * 37 + c * 91 + i * i) % 256));
    return texels;
}

/// The mean of the four texels above, for sizes that halve exactly.
uint8_t
meanOfFour(const Texels& above, uint32_t aboveWidth, uint32_t x, uint32_t y, uint32_t channel) {
    int sum = 0;
    for (uint32_t dy = 0; dy < 2; ++dy)
        for (uint32_t dx = 0; dx < 2; ++dx)
            sum += above[((2 * y + dy) * aboveWidth + 2 * x + dx) * 4 + channel];
    return static_cast<uint8_t>((sum + 2) / 4);
}

TEST_F(Upload, EachLevelIsTheMeanOfTheOneAbove) {
    const uint32_t width = 16;
    const uint32_t height = 8;
    const gpu::Image image =
        makeTexture(device(), width, height, VK_FORMAT_R8G8B8A8_UNORM, makePattern(width, height));
    ASSERT_EQ(image.desc().mipLevels, 5u);
    Texels above = readLevel(device(), image, 0);
    for (uint32_t level = 1; level <= 3; ++level) {
        const uint32_t aboveWidth = width >> (level - 1);
        const Texels texels = readLevel(device(), image, level);
        for (uint32_t y = 0; y < height >> level; ++y)
            for (uint32_t x = 0; x < width >> level; ++x)
                for (uint32_t c = 0; c < 4; ++c)
                    // A filter in fixed point and one rounding: a step to either side.
                    EXPECT_NEAR(
                        texels[(y * (width >> level) + x) * 4 + c],
                        meanOfFour(above, aboveWidth, x, y, c),
                        1
                    ) << "level "
                      << level << " at " << x << ", " << y;
        above = texels;
    }
    // The last halves 2 x 1 to 1 x 1.
    const Texels last = readLevel(device(), image, 4);
    for (uint32_t c = 0; c < 4; ++c)
        EXPECT_NEAR(last[c], (above[c] + above[4 + c]) / 2, 1);
}

TEST_F(Upload, SrgbLevelsAreAveragedInLinearLight) {
    // Black and white, half each: linear 0.5 is sRGB 188, not 128.
    const Texels texels{255, 255, 255, 255, 0, 0, 0, 255, 0, 0, 0, 255, 255, 255, 255, 255};
    const gpu::Image image = makeTexture(device(), 2, 2, VK_FORMAT_R8G8B8A8_SRGB, texels);
    const Texels last = readLevel(device(), image, 1);
    EXPECT_NEAR(last[0], 188, 1);
    EXPECT_EQ(last[3], 255);
}

TEST_F(Upload, OddSizesKeepAConstantColour) {
    EXPECT_EQ(gpu::countMipLevels(1, 1), 1u);
    EXPECT_EQ(gpu::countMipLevels(2, 1), 2u);
    EXPECT_EQ(gpu::countMipLevels(3, 3), 2u);
    EXPECT_EQ(gpu::countMipLevels(1024, 5), 11u);
    Texels texels;
    for (int i = 0; i < 7 * 5; ++i)
        texels.insert(texels.end(), {200, 100, 50, 255});
    const gpu::Image image = makeTexture(device(), 7, 5, VK_FORMAT_R8G8B8A8_UNORM, texels);
    ASSERT_EQ(image.desc().mipLevels, 3u);
    for (uint32_t level = 0; level < 3; ++level)
        EXPECT_EQ(readLevel(device(), image, level)[1], 100) << level;
}

/// Uploads together. \param parts submissions that it takes
/// \return the textures
std::deque<gpu::Image> uploadAll(
    gpu::Device& device,
    const std::vector<std::pair<uint32_t, uint32_t>>& sizes,
    bool hasLevels,
    uint64_t parts
) {
    std::deque<gpu::Image> images;
    std::deque<Texels> texels;
    std::vector<gpu::TextureUpload> uploads;
    for (const auto& [width, height] : sizes) {
        gpu::Image& image = images.emplace_back(
            makeImage(device, width, height, VK_FORMAT_R8G8B8A8_UNORM, hasLevels)
        );
        texels.push_back(makePattern(width, height));
        uploads.push_back({&image, std::as_bytes(std::span(texels.back()))});
    }
    const uint64_t before = device.completedValue();
    gpu::uploadTextures(device, uploads);
    EXPECT_EQ(device.completedValue(), before + parts);
    for (size_t i = 0; i < images.size(); ++i)
        EXPECT_EQ(readLevel(device, images[i], 0), texels[i]) << i;
    return images;
}

TEST_F(Upload, ManyTexturesShareASubmissionAndAreWhatWasUploadedBitForBit) {
    std::vector<std::pair<uint32_t, uint32_t>> sizes{{1, 1}, {8, 4}, {1, 7}};
    for (uint32_t i = 0; i < 40; ++i)
        sizes.emplace_back(3 + i, 1 + i / 2);
    for (const gpu::Image& image : uploadAll(device(), sizes, true, 1)) {
        const auto& [width, height] = std::pair(image.desc().width, image.desc().height);
        const gpu::Image alone = makeTexture(
            device(), width, height, VK_FORMAT_R8G8B8A8_UNORM, makePattern(width, height)
        );
        EXPECT_EQ(readLevel(device(), alone, 0), makePattern(width, height)) << width;
        for (uint32_t level = 1; level < alone.desc().mipLevels; ++level)
            EXPECT_EQ(readLevel(device(), image, level), readLevel(device(), alone, level))
                << width << "x" << height;
    }
    gpu::uploadTextures(device(), {});
}

TEST_F(Upload, LargeUploadsAreSplitIntoParts) {
    // 3000 x 3000 texels are 36 MB: more than is staged at once, and the small ones lie around
    // them.
    (void)uploadAll(device(), {{5, 7}, {3000, 3000}, {9, 2}}, false, 2);
    std::vector<uint32_t> values(gpu::kStagingBytes / 4 + 1000);
    std::iota(values.begin(), values.end(), 7u);
    gpu::Buffer buffer(device(), "large", 4 * values.size(), 0, gpu::MemoryUse::Readback);
    gpu::uploadBuffer(device(), buffer, std::as_bytes(std::span(values)));
    EXPECT_EQ(std::memcmp(buffer.mapped(), values.data(), 4 * values.size()), 0);
}

TEST_F(Upload, ABufferIsFilledFromItsOffsetOn) {
    gpu::Buffer buffer(device(), "target", 16, 0, gpu::MemoryUse::Readback);
    const std::vector<uint32_t> before{1, 2, 3, 4};
    const std::vector<uint32_t> part{77, 88};
    gpu::uploadBuffer(device(), buffer, std::as_bytes(std::span(before)));
    gpu::uploadBuffer(device(), buffer, std::as_bytes(std::span(part)), 8);
    gpu::uploadBuffer(device(), buffer, {});
    const auto* values = static_cast<const uint32_t*>(buffer.mapped());
    EXPECT_EQ(std::vector<uint32_t>(values, values + 4), (std::vector<uint32_t>{1, 2, 77, 88}));
}

TEST_F(Upload, TenBitsAChannelAreReadInTheOrderOfTheirFormat) {
    constexpr uint32_t kLow = 0;
    constexpr uint32_t kMiddle = 341; // a third of 1023
    constexpr uint32_t kHigh = 1023;
    const std::array<uint32_t, 2> texels{
        kLow | kMiddle << 10 | kHigh << 20 | 3u << 30, kHigh | kLow << 10 | kMiddle << 20};
    for (const bool redIsLow : {true, false}) {
        const VkFormat format =
            redIsLow ? VK_FORMAT_A2B10G10R10_UNORM_PACK32 : VK_FORMAT_A2R10G10B10_UNORM_PACK32;
        gpu::Image image = makeImage(device(), uint32_t(texels.size()), 1, format, false);
        gpu::uploadTexture(device(), image, std::as_bytes(std::span(texels)));
        test::GraphRig rig(device());
        const size_t ticket = rig.want(rig.graph.importImage(
            "ten bits", image, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, VK_IMAGE_LAYOUT_UNDEFINED
        ));
        test::run(rig);
        const image::Image read = rig.take(ticket);
        const uint32_t red = redIsLow ? 0 : 2;
        EXPECT_EQ(read.at(0, 0, red), 0.0f);
        EXPECT_FLOAT_EQ(read.at(0, 0, 1), 1.0f / 3.0f);
        EXPECT_EQ(read.at(0, 0, 2 - red), 1.0f);
        EXPECT_EQ(read.at(0, 0, 3), 1.0f);
        EXPECT_EQ(read.at(1, 0, red), 1.0f);
        EXPECT_EQ(read.at(1, 0, 1), 0.0f);
        EXPECT_FLOAT_EQ(read.at(1, 0, 2 - red), 1.0f / 3.0f);
        EXPECT_EQ(read.at(1, 0, 3), 0.0f);
    }
}

} // namespace
} // namespace shutter
