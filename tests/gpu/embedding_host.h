// SPDX-License-Identifier: MIT
// A host that embeds the motion blur by raw Vulkan handles.
#pragma once

#include "engine/gpu/memory.h"
#include "engine/graph/types.h"
#include "engine/image/image.h"
#include "engine/math/math.h"
#include "modules/motion_blur/embedding/embedded_motion_blur.h"
#include "modules/motion_blur/methods.h"
#include "tests/support/gpu_fixture.h"

#include <glm/gtc/packing.hpp>

#include <cstdint>
#include <cstring>
#include <memory>
#include <utility>

namespace shutter::test {

inline constexpr graph::OutsideUse kSampled{
    VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
    VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
    VK_ACCESS_2_SHADER_SAMPLED_READ_BIT};
inline constexpr graph::OutsideUse kCopied{
    VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
    VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT,
    VK_ACCESS_2_TRANSFER_READ_BIT};
inline constexpr graph::OutsideUse kWritten{
    VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
    VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT,
    VK_ACCESS_2_TRANSFER_WRITE_BIT};
inline constexpr graph::OutsideUse kNothing{
    VK_IMAGE_LAYOUT_UNDEFINED, VK_PIPELINE_STAGE_2_NONE, VK_ACCESS_2_NONE};

inline void moveOn(
    VkCommandBuffer commands,
    VkImage image,
    const graph::OutsideUse& before,
    const graph::OutsideUse& after,
    uint32_t layer = 0
) {
    VkImageMemoryBarrier2 barrier{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2};
    barrier.srcStageMask = before.stages;
    barrier.srcAccessMask = before.access;
    barrier.dstStageMask = after.stages;
    barrier.dstAccessMask = after.access;
    barrier.oldLayout = before.layout;
    barrier.newLayout = after.layout;
    barrier.image = image;
    barrier.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, layer, 1};
    VkDependencyInfo dependency{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
    dependency.imageMemoryBarrierCount = 1;
    dependency.pImageMemoryBarriers = &barrier;
    vkCmdPipelineBarrier2(commands, &dependency);
}

inline gpu::Image
makeImage(gpu::Device& device, const char* name, VkFormat format, uint32_t width, uint32_t height) {
    return {
        device,
        name,
        {width,
         height,
         format,
         VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT |
             VK_IMAGE_USAGE_TRANSFER_DST_BIT}};
}

/// The image is as kCopied says, the buffer one for reading.
inline void
copyToBuffer(VkCommandBuffer commands, const gpu::Image& image, const gpu::Buffer& buffer) {
    VkBufferImageCopy region{};
    region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    region.imageExtent = {image.desc().width, image.desc().height, 1};
    vkCmdCopyImageToBuffer(commands, image.handle(), kCopied.layout, buffer.handle(), 1, &region);
    VkMemoryBarrier2 barrier{VK_STRUCTURE_TYPE_MEMORY_BARRIER_2};
    barrier.srcStageMask = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT;
    barrier.srcAccessMask = VK_ACCESS_2_TRANSFER_WRITE_BIT;
    barrier.dstStageMask = VK_PIPELINE_STAGE_2_HOST_BIT;
    barrier.dstAccessMask = VK_ACCESS_2_HOST_READ_BIT;
    VkDependencyInfo dependency{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
    dependency.memoryBarrierCount = 1;
    dependency.pMemoryBarriers = &barrier;
    vkCmdPipelineBarrier2(commands, &dependency);
}

/// A picture in half floats that is copied to where the CPU reads it.
class Picture {
  public:
    Picture(gpu::Device& device, const char* name, math::uvec2 sizePx)
        : mSize(sizePx),
          mImage(makeImage(device, name, VK_FORMAT_R16G16B16A16_SFLOAT, sizePx.x, sizePx.y)),
          mPixels(device, name, sizePx.x * sizePx.y * 8ull, 0, gpu::MemoryUse::Readback) {}

    [[nodiscard]] VkImage handle() const { return mImage.handle(); }

    /// The image is as kCopied says.
    void recordReadback(VkCommandBuffer commands) const { copyToBuffer(commands, mImage, mPixels); }

    [[nodiscard]] image::Image read() const {
        image::Image picture(mSize.x, mSize.y, 4);
        const auto* texels = static_cast<const uint64_t*>(mPixels.mapped());
        for (size_t i = 0; i < size_t{mSize.x} * mSize.y; ++i) {
            const glm::vec4 value = glm::unpackHalf4x16(texels[i]);
            std::memcpy(&picture.pixels[4 * i], &value, sizeof(value));
        }
        return picture;
    }

  private:
    math::uvec2 mSize;
    gpu::Image mImage;
    gpu::Buffer mPixels;
};

/// Pictures of the host that are cleared in each frame, and a command buffer of its own.
struct HostFrame {
    HostFrame(gpu::Device& device, uint32_t w, uint32_t h)
        : width(w), height(h),
          color(makeImage(device, "color", VK_FORMAT_R16G16B16A16_SFLOAT, w, h)),
          motionDepth(makeImage(device, "motion", VK_FORMAT_R32G32B32A32_SFLOAT, w, h)),
          output(makeImage(device, "output", VK_FORMAT_R16G16B16A16_SFLOAT, w, h)) {}

    [[nodiscard]] motion_blur::HostInputs inputs() const {
        motion_blur::HostInputs in;
        in.width = width;
        in.height = height;
        in.color = {color.handle(), kWritten, kSampled};
        in.motionDepth = {motionDepth.handle(), kWritten, kSampled};
        in.output = {output.handle(), kNothing, kCopied};
        return in;
    }

    void recordClears(VkCommandBuffer commands) const {
        const VkImageSubresourceRange all{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
        for (const gpu::Image* image : {&color, &motionDepth}) {
            moveOn(commands, image->handle(), kNothing, kWritten);
            const VkClearColorValue value{{3.0f, 2.0f, 1.0f, 1.0f}};
            vkCmdClearColorImage(commands, image->handle(), kWritten.layout, &value, 1, &all);
        }
    }

    uint32_t width;
    uint32_t height;
    gpu::Image color;
    gpu::Image motionDepth;
    gpu::Image output;
};

inline motion_blur::MotionBlurSettings gather() {
    motion_blur::MotionBlurSettings settings;
    settings.method = &motion_blur::getMethod("gather");
    return settings;
}

/// The tests' device as a host hands it over.
class EmbeddedTest : public GpuTest {
  protected:
    static motion_blur::HostDevice describeHost() {
        motion_blur::HostDevice host;
        host.physical = device().physical();
        host.device = device().handle();
        host.queueFamily = device().queueFamily();
        host.hasDebugUtils = true;
        return host;
    }

    static std::unique_ptr<motion_blur::EmbeddedMotionBlur>
    create(const motion_blur::HostDevice& host) {
        auto blur = motion_blur::EmbeddedMotionBlur::create(host);
        EXPECT_TRUE(blur.ok()) << blur.error().message;
        return blur.ok() ? std::move(blur).value() : nullptr;
    }
};

} // namespace shutter::test
