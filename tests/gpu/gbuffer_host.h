// SPDX-License-Identifier: MIT
// A host that has the engine's own G-buffer.
#pragma once

#include "engine/graph/execute.h"
#include "engine/graph/graph.h"
#include "engine/render/post_effect.h"
#include "modules/motion_blur/embedding/embedded_motion_blur.h"
#include "tests/gpu/c_inputs.h"
#include "tests/gpu/embedding_host.h"

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace shutter::test {

inline VkImageCopy wholeCopy(uint32_t width, uint32_t height) {
    VkImageCopy region{};
    region.srcSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    region.dstSubresource = region.srcSubresource;
    region.extent = {width, height, 1};
    return region;
}

/// An effect of the C interface on the device of the tests.
class BlurOfC {
  public:
    explicit BlurOfC(const gpu::Device& device) {
        ShutterBlurDevice described = shutterBlurDefaultDevice();
        described.physical = device.physical();
        described.device = device.handle();
        described.queueFamily = device.queueFamily();
        EXPECT_EQ(shutterBlurCreate(&described, &blur), SHUTTER_BLUR_SUCCESS)
            << shutterBlurGetMessage();
    }

    ~BlurOfC() { shutterBlurDestroy(blur); }

    BlurOfC(const BlurOfC&) = delete;
    BlurOfC& operator=(const BlurOfC&) = delete;

    ShutterBlur* blur = nullptr;
};

/// What scene::ResponseShape::Triangle is.
[[nodiscard]] inline std::vector<math::ResponsePoint> triangleResponse() {
    return {{0.0, 0.0}, {0.5, 1.0}, {1.0, 0.0}};
}

/// Takes the engine's G-buffer as a host would give its own: raw handles of images in the layouts
/// they happen to have. Blurs it into another picture (view 0) and, a copy of it, in place (view
/// 1); the frame goes on with what it was.
class HostOfTheGBuffer : public render::PostEffect {
  public:
    HostOfTheGBuffer(
        gpu::Device& device,
        motion_blur::EmbeddedMotionBlur& blur,
        const motion_blur::MotionBlurSettings& settings,
        math::uvec2 sizePx
    )
        : output(device, "output", sizePx), inPlace(device, "in place", sizePx),
          byC(device, "by C", sizePx), mBlur(blur), mSettings(settings) {}

    Picture output;
    Picture inPlace;
    /// With it the C interface draws the same picture once more, under its number 0.
    ShutterBlur* blurOfC = nullptr;
    Picture byC;
    /// The response of the frame as C has it, which takes no address of a table.
    std::vector<math::ResponsePoint> responseForC;
    int64_t frameNumber = 0;
    /// Says how things move in the frame. What it points to must last until the frame is recorded.
    std::function<void(const render::PostContext&, motion_blur::HostMotion&)> describeMotion;

    /// Turns the rays that are handed in into a reveal of the host's own.
    std::function<void(motion_blur::HostInputs&)> takeRays;
    /// Says whatever else the host hands in. What it points to must last until the frame has ended.
    std::function<void(const render::PostContext&, motion_blur::HostInputs&)> changeInputs;
    /// Changes what rays meet. What it points to must last until the frame has ended.
    std::function<void(const render::PostContext&, motion_blur::HostRays&)> changeRays;

    [[nodiscard]] std::string name() const override { return "host"; }

    [[nodiscard]] core::Decision ask(const render::ViewFacts&) const override {
        return {true, "it is looked at"};
    }

    void declare(render::PostContext& context) override {
        struct Data {
            graph::ImageHandle color, motionDepth, normal, entityId;
        };

        motion_blur::HostInputs inputs;
        inputs.width = context.facts.width;
        inputs.height = context.facts.height;
        inputs.rasterTime = context.facts.rasterTime;
        inputs.response = context.response;
        inputs.frameNumber = frameNumber;
        inputs.rays.frameConstants = context.frameConstants;
        if (context.rays) {
            inputs.rays.tlas = context.rays->tlas;
            inputs.rays.scene = context.rays->textures;
            inputs.rays.frameConstants = context.rays->frameConstants;
            inputs.rays.hasBlended = context.rays->hasBlended;
        }
        if (changeRays)
            changeRays(context, inputs.rays);
        if (describeMotion)
            describeMotion(context, inputs.motion);
        if (changeInputs)
            changeInputs(context, inputs);
        using graph::Access;
        const auto timed = context.timedRays;
        const graph::BufferHandle level =
            context.rays ? context.rays->tlasBuffer : graph::BufferHandle{};
        context.graph.addPass<Data>(
            "host",
            graph::PassKind::Compute,
            [&](graph::PassBuilder& builder, Data& data) {
                data.color = builder.read(context.color, Access::SampledCompute);
                data.motionDepth =
                    builder.read(context.gbuffer.motionDepth, Access::SampledCompute);
                data.normal = builder.read(context.gbuffer.normal, Access::SampledCompute);
                data.entityId = builder.read(context.gbuffer.entityId, Access::SampledCompute);
                if (level.isValid())
                    builder.read(level, Access::AccelerationRead);
                if (timed)
                    for (const graph::BufferHandle buffer : {timed->tlasBuffer, timed->boxesBuffer})
                        if (buffer.isValid())
                            builder.read(buffer, Access::AccelerationRead);
                builder.sideEffect();
            },
            [this, inputs, level](const Data& data, graph::PassContext& pass) {
                const auto give = [&](graph::ImageHandle image) {
                    return motion_blur::HostImage{
                        pass.resources.image(image).handle(), kSampled, kSampled};
                };
                motion_blur::HostInputs given = inputs;
                given.color = give(data.color);
                given.motionDepth = give(data.motionDepth);
                given.normal = give(data.normal);
                given.entityId = give(data.entityId);
                if (level.isValid())
                    given.rays.tlasBuffer = pass.resources.buffer(level);
                if (takeRays)
                    takeRays(given);
                recordBoth(pass.commands, given);
            }
        );
    }

  private:
    void recordBoth(VkCommandBuffer commands, motion_blur::HostInputs& inputs) {
        inputs.output = {output.handle(), kNothing, kCopied};
        const core::Status other = mBlur.record(commands, 0, inputs, mSettings);
        ASSERT_TRUE(other.ok()) << other.error().message;
        output.recordReadback(commands);
        if (blurOfC)
            recordByC(commands, inputs);

        const VkImage color = inputs.color.image;
        moveOn(commands, color, kSampled, kCopied);
        moveOn(commands, inPlace.handle(), kNothing, kWritten);
        const VkImageCopy region = wholeCopy(inputs.width, inputs.height);
        vkCmdCopyImage(
            commands, color, kCopied.layout, inPlace.handle(), kWritten.layout, 1, &region
        );
        moveOn(commands, color, kCopied, kSampled);
        inputs.output = {};
        inputs.color = {inPlace.handle(), kWritten, kCopied};
        inputs.motion.view = 1;
        const core::Status same = mBlur.record(commands, 1, inputs, mSettings);
        ASSERT_TRUE(same.ok()) << same.error().message;
        inPlace.recordReadback(commands);
    }

    void recordByC(VkCommandBuffer commands, const motion_blur::HostInputs& inputs) {
        motion_blur::HostInputs given = inputs;
        given.output = {byC.handle(), kNothing, kCopied};
        given.responsePoints = responseForC;
        const InputsForC told(given);
        ShutterBlurSettings settings = shutterBlurDefaultSettings();
        settings.method = mSettings.method->name;
        settings.sampleCount = mSettings.sampleCount;
        const std::string rays = std::to_string(mSettings.raysPerPixel);
        const ShutterBlurValue value{"raysPerPixel", rays.c_str()};
        settings.values = &value;
        settings.valueCount = 1;
        ASSERT_EQ(
            shutterBlurRecord(blurOfC, commands, 0, &told.inputs, &settings), SHUTTER_BLUR_SUCCESS
        ) << shutterBlurGetMessage();
        byC.recordReadback(commands);
    }

    motion_blur::EmbeddedMotionBlur& mBlur;
    motion_blur::MotionBlurSettings mSettings;
};

} // namespace shutter::test
