// SPDX-License-Identifier: MIT
// Textures with their mip levels and buffers, read back; pictures of window formats are read back
// as shown.
#include "engine/gpu/memory.h"
#include "engine/gpu/upload.h"
#include "tests/gpu/effect_rig.h"
#include "tests/support/gpu_fixture.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <deque>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

namespace shutter {
namespace {

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

TEST_F(Upload, LevelZeroIsWhatWasUploadedBitForBit) {
    for (const auto& [width, height] : {std::pair{1u, 1u}, {8u, 4u}, {5u, 3u}, {1u, 7u}}) {
        const Texels texels = makePattern(width, height);
        const gpu::Image image =
            makeTexture(device(), width, height, VK_FORMAT_R8G8B8A8_UNORM, texels);
        EXPECT_EQ(readLevel(device(), image, 0), texels) << width << "x" << height;
    }
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

TEST_F(Upload, ManyTexturesShareASubmission) {
    std::vector<std::pair<uint32_t, uint32_t>> sizes;
    for (uint32_t i = 0; i < 40; ++i)
        sizes.emplace_back(3 + i, 1 + i / 2);
    for (const gpu::Image& image : uploadAll(device(), sizes, true, 1)) {
        const auto& [width, height] = std::pair(image.desc().width, image.desc().height);
        const gpu::Image alone = makeTexture(
            device(), width, height, VK_FORMAT_R8G8B8A8_UNORM, makePattern(width, height)
        );
        EXPECT_EQ(readLevel(device(), image, 1), readLevel(device(), alone, 1)) << width;
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
