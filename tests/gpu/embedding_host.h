// SPDX-License-Identifier: MIT
// A host that embeds the motion blur by raw Vulkan handles, and its inputs in the words of the C
// interface.
#pragma once

#include "engine/gpu/frame.h"
#include "engine/gpu/memory.h"
#include "engine/gpu/pipeline.h"
#include "engine/gpu/vulkan.h"
#include "engine/graph/types.h"
#include "engine/image/image.h"
#include "engine/math/math.h"
#include "modules/motion_blur/c_interface/shutter_motion_blur.h"
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

    /// Texels of depth with a stencil are all depths, then all stencils, or the first alone.
    void record(VkCommandBuffer commands) const {
        const VkImageAspectFlags aspects = gpu::aspectOf(mFormat);
        moveOn(commands, mImage.handle(), kNothing, kWritten, {aspects, 0, 1, 0, 1});
        VkBufferImageCopy region{};
        region.imageExtent = {mExtent.width, mExtent.height, 1};
        for (const VkImageAspectFlags aspect :
             {VK_IMAGE_ASPECT_COLOR_BIT, VK_IMAGE_ASPECT_DEPTH_BIT, VK_IMAGE_ASPECT_STENCIL_BIT}) {
            if ((aspects & aspect) == 0 || region.bufferOffset >= mStaging.bytes())
                continue;
            region.imageSubresource = {aspect, 0, 0, 1};
            vkCmdCopyBufferToImage(
                commands, mStaging.handle(), mImage.handle(), kWritten.layout, 1, &region
            );
            region.bufferOffset += 4ull * mExtent.width * mExtent.height;
        }
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

/// A compute shader of the host's, with what its recordings hold until the GPU is done.
class HostShader {
  public:
    HostShader(gpu::Device& device, const gpu::ComputePipelineDesc& desc)
        : mDevice(device), mPipeline(device, desc) {}

    /// Binds it for the next dispatch.
    template <class Push>
    void bind(
        VkCommandBuffer commands,
        const gpu::BindingList& bindings,
        const Push& push,
        VkDescriptorSet scene = VK_NULL_HANDLE
    ) {
        gpu::Frame& frame = *mFrames.emplace_back(gpu::Frame::createForHost(mDevice));
        frame.beginIn(commands);
        frame.bind(mPipeline, bindings, &push, sizeof(push), scene);
    }

    /// An image that was handed over to it.
    const gpu::Image&
    adopt(VkImage image, VkExtent2D size, VkFormat format, VkImageUsageFlags usage) {
        return mImages.emplace_back(
            gpu::Image::adopt(mDevice, "host's", image, {size.width, size.height, format, usage})
        );
    }

  private:
    gpu::Device& mDevice;
    gpu::Pipeline mPipeline;
    std::deque<gpu::Image> mImages;
    std::vector<std::unique_ptr<gpu::Frame>> mFrames;
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

/// The tests' device as a host hands it over, and an effect on it, which the tests of a suite
/// share: its pipelines take lavapipe seconds.
class EmbeddedTest : public GpuTest {
  protected:
    static void TearDownTestSuite() { sKept.reset(); }

    void SetUp() override {
        GpuTest::SetUp();
        if (!IsSkipped() && !HasFatalFailure())
            mBlur = sKept ? std::move(sKept) : create(hostOfSuite());
        mShared = mBlur.get();
    }

    void TearDown() override {
        mTexels.clear();
        keepShared();
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

    /// The host of the effect that tests share; nothing that it refers to may die with a test.
    [[nodiscard]] virtual motion_blur::HostDevice hostOfSuite() const { return describeHost(); }

    static std::unique_ptr<motion_blur::EmbeddedMotionBlur>
    create(const motion_blur::HostDevice& host) {
        auto blur = motion_blur::EmbeddedMotionBlur::create(host);
        EXPECT_TRUE(blur.ok()) << blur.error().message;
        return blur.ok() ? std::move(blur).value() : nullptr;
    }

    /// Another effect until the test ends.
    void useOwn(const motion_blur::HostDevice& host) {
        keepShared();
        mBlur = create(host);
    }

    /// A new effect for this test and those after it.
    void replaceShared() {
        mBlur = create(hostOfSuite());
        mShared = mBlur.get();
    }

    /// No recording is pending, and no view has a frame before its next one.
    void forgetFrames() {
        const uint32_t count = hostOfSuite().framesInFlight;
        for (uint32_t i = 0; i < count; ++i)
            EXPECT_TRUE(mBlur->markDone(i).ok() && mBlur->closeView(i).ok());
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

  private:
    /// Sets the shared effect aside for the next test; after a failure that has another one.
    void keepShared() {
        if (!mBlur || mBlur.get() != mShared)
            return;
        device().waitIdle();
        forgetFrames();
        if (!HasFailure())
            sKept = std::move(mBlur);
        mBlur.reset();
    }

    static inline std::unique_ptr<motion_blur::EmbeddedMotionBlur> sKept;
    const motion_blur::EmbeddedMotionBlur* mShared = nullptr;
};

inline ShutterBlurDevice describeForC(const gpu::Device& device) {
    ShutterBlurDevice described = shutterBlurDefaultDevice();
    described.physical = device.physical();
    described.device = device.handle();
    described.queueFamily = device.queueFamily();
    described.hasDebugUtils = VK_TRUE;
    return described;
}

class BlurOfC {
  public:
    explicit BlurOfC(const ShutterBlurDevice& described) {
        EXPECT_EQ(shutterBlurCreate(&described, &blur), SHUTTER_BLUR_SUCCESS)
            << shutterBlurGetMessage();
    }

    explicit BlurOfC(const gpu::Device& device) : BlurOfC(describeForC(device)) {}

    ~BlurOfC() { shutterBlurDestroy(blur); }

    BlurOfC(const BlurOfC&) = delete;
    BlurOfC& operator=(const BlurOfC&) = delete;

    ShutterBlur* blur = nullptr;
};

inline ShutterBlurImage convertForC(const motion_blur::HostImage& image) {
    const auto use = [](const graph::OutsideUse& given) {
        return ShutterBlurUse{given.layout, given.stages, given.access};
    };
    ShutterBlurImage made{};
    made.image = image.image;
    made.format = image.format;
    made.extent = image.extent;
    made.area = image.area;
    made.usage = image.usage;
    made.layer = image.layer;
    made.before = use(image.before);
    made.after = use(image.after);
    return made;
}

/// What `inputs` points to; both must last until it is recorded.
struct InputsForC {
    explicit InputsForC(const motion_blur::HostInputs& given) : mGiven(given) {
        inputs.width = given.width;
        inputs.height = given.height;
        inputs.color = convertForC(given.color);
        inputs.output = convertForC(given.output);
        inputs.motionDepth = convertForC(given.motionDepth);
        inputs.normal = convertForC(given.normal);
        inputs.entityId = convertForC(given.entityId);
        inputs.blended = convertForC(given.blended);
        inputs.rasterTime = given.rasterTime;
        inputs.frameNumber = given.frameNumber;
        takeMotion(given.motion);
        takeCameras(given.convention);
        for (const math::ResponsePoint& point : given.responsePoints)
            mResponse.push_back({point.s, point.sensitivity});
        inputs.responsePoints = mResponse.data();
        inputs.responsePointCount = static_cast<uint32_t>(mResponse.size());
        if (given.reveal.record) {
            inputs.revealUser = this;
            inputs.recordReveal = [](void* self, const ShutterBlurRevealTask* task) {
                EXPECT_EQ(task->structBytes, sizeof(*task));
                static_cast<InputsForC*>(self)->mGiven.reveal.record(*task);
            };
        }
        if (given.samples.record) {
            inputs.samplesUser = this;
            inputs.recordSamples = [](void* self, const ShutterBlurSampleTask* task) {
                EXPECT_EQ(task->structBytes, sizeof(*task));
                static_cast<InputsForC*>(self)->mGiven.samples.record(*task);
            };
        }
        if (given.drawn.record) {
            inputs.blendedUser = this;
            inputs.recordBlended = [](void* self, const ShutterBlurBlendedTask* task) {
                EXPECT_EQ(task->structBytes, sizeof(*task));
                static_cast<InputsForC*>(self)->mGiven.drawn.record(*task);
            };
        }
        inputs.blendedArea = given.drawn.area;
        inputs.blendedInstants = given.drawn.instantCount;
        inputs.blendedParts = given.drawn.partCount;
        inputs.blendedOpacityInAlpha = given.drawn.isOpacityInAlpha ? VK_TRUE : VK_FALSE;
    }

    ShutterBlurInputs inputs = shutterBlurDefaultInputs();

  private:
    void takeMotion(const motion_blur::HostMotion& motion) {
        for (const motion_blur::HostCameraKey& key : motion.keys) {
            ShutterBlurCameraKey& made = mKeys.emplace_back();
            made.time = key.time;
            std::memcpy(made.viewFromWorld, &key.viewFromWorld, sizeof(made.viewFromWorld));
            std::memcpy(made.clipFromView, &key.clipFromView, sizeof(made.clipFromView));
        }
        for (const motion_blur::HostMover& mover : motion.movers)
            mMovers.push_back(
                {mover.row,
                 mover.worldFromObject.empty() ? nullptr : &mover.worldFromObject[0][0].x}
            );
        inputs.keyCount = static_cast<uint32_t>(mKeys.size());
        inputs.keys = mKeys.data();
        inputs.moverCount = static_cast<uint32_t>(mMovers.size());
        inputs.movers = mMovers.data();
        inputs.rowCount = motion.rowCount;
        inputs.rowIds = motion.rowIds.empty() ? nullptr : motion.rowIds.data();
        inputs.followsLast = motion.followsLast ? VK_TRUE : VK_FALSE;
        ShutterBlurLens& lens = inputs.lens;
        lens.radius = motion.lens.radius;
        lens.focusDistance = motion.lens.focusDistance;
        if (!motion.lens.focusDistances.empty())
            lens.focusDistances = motion.lens.focusDistances.data();
        lens.bladeRotation = motion.lens.bladeRotation;
        lens.roundness = motion.lens.roundness;
        lens.squeeze = motion.lens.squeeze;
        lens.blades = motion.lens.blades;
        inputs.cameras.aheadIsPlusZ = motion.aheadIsPlusZ ? VK_TRUE : VK_FALSE;
    }

    void takeCameras(const motion_blur::HostConvention& convention) {
        const motion_blur::HostCameras& cameras = convention.cameras;
        ShutterBlurCameras& made = inputs.cameras;
        const auto copy = [](double* to, const glm::dmat4& from) {
            std::memcpy(to, &from, sizeof(from));
        };
        made.areGiven = cameras.areGiven ? VK_TRUE : VK_FALSE;
        copy(made.viewFromWorld, cameras.viewFromWorld);
        copy(made.clipFromView, cameras.clipFromView);
        copy(made.viewFromWorldBefore, cameras.viewFromWorldBefore);
        copy(made.clipFromViewBefore, cameras.clipFromViewBefore);
        inputs.exposureShare = convention.scales.exposureShare;
        inputs.cameraScale = convention.scales.camera;
        inputs.objectScale = convention.scales.object;
    }

    const motion_blur::HostInputs& mGiven;
    std::vector<ShutterBlurCameraKey> mKeys;
    std::vector<ShutterBlurMover> mMovers;
    std::vector<ShutterBlurResponsePoint> mResponse;
};

} // namespace shutter::test
