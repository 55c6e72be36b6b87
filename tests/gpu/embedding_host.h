// SPDX-License-Identifier: MIT
// A host that embeds the motion blur by raw Vulkan handles.
#pragma once

#include "engine/gpu/frame.h"
#include "engine/gpu/memory.h"
#include "engine/gpu/vulkan.h"
#include "engine/graph/types.h"
#include "engine/image/image.h"
#include "engine/math/math.h"
#include "modules/motion_blur/embedding/embedded_motion_blur.h"
#include "modules/motion_blur/methods.h"
#include "tests/support/gpu_fixture.h"

#include <glm/gtc/packing.hpp>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <deque>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

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

inline constexpr VkImageUsageFlags kAllUsage =
    VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT |
    VK_IMAGE_USAGE_TRANSFER_DST_BIT;

inline void moveOn(
    VkCommandBuffer commands,
    VkImage image,
    const graph::OutsideUse& before,
    const graph::OutsideUse& after,
    VkImageSubresourceRange range = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1}
) {
    VkImageMemoryBarrier2 barrier{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2};
    barrier.srcStageMask = before.stages;
    barrier.srcAccessMask = before.access;
    barrier.dstStageMask = after.stages;
    barrier.dstAccessMask = after.access;
    barrier.oldLayout = before.layout;
    barrier.newLayout = after.layout;
    barrier.image = image;
    barrier.subresourceRange = range;
    VkDependencyInfo dependency{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
    dependency.imageMemoryBarrierCount = 1;
    dependency.pImageMemoryBarriers = &barrier;
    vkCmdPipelineBarrier2(commands, &dependency);
}

inline gpu::Image
makeImage(gpu::Device& device, const char* name, VkFormat format, uint32_t width, uint32_t height) {
    return {device, name, {width, height, format, kAllUsage}};
}

/// The image is in the state kWritten afterwards.
inline void
clear(VkCommandBuffer commands, const gpu::Image& image, const VkClearColorValue& value) {
    const VkImageSubresourceRange all{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    moveOn(commands, image.handle(), kNothing, kWritten);
    vkCmdClearColorImage(commands, image.handle(), kWritten.layout, &value, 1, &all);
}

inline VkImageCopy wholeCopy(uint32_t width, uint32_t height, uint32_t sourceLayer = 0) {
    VkImageCopy region{};
    region.srcSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, sourceLayer, 1};
    region.dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    region.extent = {width, height, 1};
    return region;
}

/// The image is in the state kCopied, the buffer is one for reading.
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
    Picture(gpu::Device& device, math::uvec2 sizePx)
        : mSize(sizePx),
          mImage(makeImage(device, "picture", VK_FORMAT_R16G16B16A16_SFLOAT, sizePx.x, sizePx.y)),
          mPixels(device, "pixels", sizePx.x * sizePx.y * 8ull, 0, gpu::MemoryUse::Readback) {}

    [[nodiscard]] VkImage handle() const { return mImage.handle(); }

    /// As an output, which recordReadback() may follow.
    [[nodiscard]] motion_blur::HostImage output() const { return {handle(), kNothing, kCopied}; }

    /// The image is in the state kCopied.
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

/// Pictures of the host that are cleared in each frame.
struct HostFrame {
    HostFrame(gpu::Device& device, uint32_t w, uint32_t h)
        : width(w), height(h),
          color(makeImage(device, "color", VK_FORMAT_R16G16B16A16_SFLOAT, w, h)),
          motionDepth(makeImage(device, "motion", VK_FORMAT_R32G32B32A32_SFLOAT, w, h)),
          output(makeImage(device, "output", VK_FORMAT_R16G16B16A16_SFLOAT, w, h)),
          entityId(makeImage(device, "entity id", VK_FORMAT_R32_UINT, w, h)) {}

    /// Without entity ids.
    [[nodiscard]] motion_blur::HostInputs inputs() const {
        motion_blur::HostInputs in;
        in.width = width;
        in.height = height;
        in.color = {color.handle(), kWritten, kSampled};
        in.motionDepth = {motionDepth.handle(), kWritten, kSampled};
        in.output = {output.handle(), kNothing, kCopied};
        return in;
    }

    [[nodiscard]] motion_blur::HostImage ids() const {
        return {entityId.handle(), kWritten, kSampled};
    }

    /// All pixels are of entity 0.
    void recordClears(VkCommandBuffer commands) const {
        for (const gpu::Image* image : {&color, &motionDepth})
            clear(commands, *image, {{3.0f, 2.0f, 1.0f, 1.0f}});
        clear(commands, entityId, {});
    }

    uint32_t width;
    uint32_t height;
    gpu::Image color;
    gpu::Image motionDepth;
    gpu::Image output;
    gpu::Image entityId;
};

/// An image of the host with texels of main memory, as the shader reads it afterwards.
class HostTexels {
  public:
    HostTexels(
        gpu::Device& device,
        VkFormat format,
        VkExtent2D extent,
        std::span<const std::byte> texels,
        VkImageUsageFlags more = 0
    )
        : mExtent(extent), mFormat(format),
          mImage(
              device,
              "host's",
              {extent.width,
               extent.height,
               format,
               VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT |
                   VK_IMAGE_USAGE_TRANSFER_SRC_BIT | more}
          ),
          mStaging(device, "staging", texels.size(), 0, gpu::MemoryUse::Staging) {
        mStaging.writeBytes(texels.data(), texels.size(), 0);
    }

    void record(VkCommandBuffer commands) const {
        const VkImageAspectFlags aspect = gpu::aspectOf(mFormat);
        moveOn(commands, mImage.handle(), kNothing, kWritten, {aspect, 0, 1, 0, 1});
        VkBufferImageCopy region{};
        // Depth alone is copied of an image that has a stencil, too.
        region.imageSubresource = {
            aspect & ~VkImageAspectFlags(VK_IMAGE_ASPECT_STENCIL_BIT), 0, 0, 1};
        region.imageExtent = {mExtent.width, mExtent.height, 1};
        vkCmdCopyBufferToImage(
            commands, mStaging.handle(), mImage.handle(), kWritten.layout, 1, &region
        );
    }

    [[nodiscard]] motion_blur::HostImage describe(VkRect2D area = {}) const {
        motion_blur::HostImage image{mImage.handle(), kWritten, kCopied};
        image.format = mFormat;
        image.extent = mExtent;
        image.area = area;
        image.usage = mImage.desc().usage;
        image.samples = VK_SAMPLE_COUNT_1_BIT;
        return image;
    }

    [[nodiscard]] const gpu::Image& image() const { return mImage; }

    [[nodiscard]] const gpu::Buffer& staging() const { return mStaging; }

    [[nodiscard]] VkExtent2D extent() const { return mExtent; }

  private:
    VkExtent2D mExtent;
    VkFormat mFormat;
    gpu::Image mImage;
    gpu::Buffer mStaging;
};

/// An image of two layers, such as a headset's eyes.
class TwoLayers {
  public:
    TwoLayers(gpu::Device& device, VkFormat format, VkExtent2D extent)
        : mDevice(device.handle()), mExtent(extent) {
        VkImageCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO};
        info.imageType = VK_IMAGE_TYPE_2D;
        info.format = format;
        info.extent = {extent.width, extent.height, 1};
        info.mipLevels = 1;
        info.arrayLayers = 2;
        info.samples = VK_SAMPLE_COUNT_1_BIT;
        info.usage = kAllUsage;
        gpu::require(vkCreateImage(mDevice, &info, nullptr, &image), "creating layers");
        VkMemoryRequirements needs{};
        vkGetImageMemoryRequirements(mDevice, image, &needs);
        mMemory = gpu::MemoryBlock(device, needs.size, needs.memoryTypeBits);
        gpu::require(vkBindImageMemory(mDevice, image, mMemory.handle(), 0), "binding layers");
    }

    ~TwoLayers() { vkDestroyImage(mDevice, image, nullptr); }

    TwoLayers(const TwoLayers&) = delete;
    TwoLayers& operator=(const TwoLayers&) = delete;

    /// The layer is in the state kWritten afterwards.
    void copyFrom(VkCommandBuffer commands, const gpu::Buffer& texels, uint32_t layer) const {
        move(commands, kNothing, kWritten, layer);
        VkBufferImageCopy region{};
        region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, layer, 1};
        region.imageExtent = {mExtent.width, mExtent.height, 1};
        vkCmdCopyBufferToImage(commands, texels.handle(), image, kWritten.layout, 1, &region);
    }

    void move(
        VkCommandBuffer commands,
        const graph::OutsideUse& before,
        const graph::OutsideUse& after,
        uint32_t layer
    ) const {
        moveOn(commands, image, before, after, {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, layer, 1});
    }

    VkImage image = VK_NULL_HANDLE;

  private:
    VkDevice mDevice;
    VkExtent2D mExtent;
    gpu::MemoryBlock mMemory;
};

template <class T> [[nodiscard]] std::span<const std::byte> bytesOf(const std::vector<T>& values) {
    return std::as_bytes(std::span<const T>(values));
}

inline uint64_t packHalf(const glm::vec4& value) {
    return glm::packHalf4x16(value);
}

inline motion_blur::MotionBlurSettings settingsOf(const char* method, uint32_t samples = 0) {
    motion_blur::MotionBlurSettings settings;
    settings.method = &motion_blur::getMethod(method);
    if (samples > 0)
        settings.sampleCount = samples;
    return settings;
}

inline motion_blur::MotionBlurSettings gather() {
    return settingsOf("gather");
}

inline void expectRefusal(const core::Status& status, const std::string& part) {
    ASSERT_FALSE(status.ok()) << "expected: " << part;
    EXPECT_NE(status.error().message.find(part), std::string::npos)
        << "expected: " << part << "\n got: " << status.error().message;
}

/// The tests' device as a host hands it over, and an effect on it.
class EmbeddedTest : public GpuTest {
  protected:
    void SetUp() override {
        GpuTest::SetUp();
        if (!IsSkipped() && !HasFatalFailure())
            mBlur = create(describeHost());
    }

    void TearDown() override {
        mTexels.clear();
        mBlur.reset();
        GpuTest::TearDown();
    }

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

    /// Records, submits and waits.
    static void submit(const std::function<void(VkCommandBuffer)>& record) {
        gpu::Frame frame(device());
        frame.begin();
        record(frame.commands());
        frame.submit();
        frame.wait();
    }

    template <class T>
    const HostTexels& makeTexels(
        VkFormat format, VkExtent2D extent, const std::vector<T>& values, VkImageUsageFlags more = 0
    ) {
        return mTexels.emplace_back(device(), format, extent, bytesOf(values), more);
    }

    /// Runs the effect with the texels that were made, and the commands recorded after it.
    void
    run(const motion_blur::HostInputs& inputs,
        const motion_blur::MotionBlurSettings& settings,
        uint32_t number,
        const std::function<void(VkCommandBuffer)>& behind) {
        submit([&](VkCommandBuffer commands) {
            for (const HostTexels& texels : mTexels)
                texels.record(commands);
            const core::Status done = mBlur->record(commands, number, inputs, settings);
            EXPECT_TRUE(done.ok()) << done.error().message;
            if (done)
                behind(commands);
        });
    }

    /// Draws into an image of the picture's size.
    image::Image draw(
        motion_blur::HostInputs inputs,
        const motion_blur::MotionBlurSettings& settings = gather(),
        uint32_t number = 0
    ) {
        const Picture output(device(), {inputs.width, inputs.height});
        inputs.output = output.output();
        run(inputs, settings, number, [&](VkCommandBuffer commands) {
            output.recordReadback(commands);
        });
        return output.read();
    }

    std::unique_ptr<motion_blur::EmbeddedMotionBlur> mBlur;
    std::deque<HostTexels> mTexels; ///< of the inputs
};

} // namespace shutter::test
