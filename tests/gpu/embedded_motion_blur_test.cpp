// SPDX-License-Identifier: MIT
// The motion blur on raw handles: what a host gets is what the plugin gives, bit for bit.
#include "engine/graph/execute.h"
#include "engine/render/renderer.h"
#include "modules/motion_blur/embedding/embedded_motion_blur.h"
#include "modules/motion_blur/plugin/motion_blur_plugin.h"
#include "tests/kit/scene_builder.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/picture.h"

#include <glm/gtc/packing.hpp>

#include <array>
#include <cstring>
#include <limits>
#include <optional>
#include <span>
#include <string>

namespace shutter {
namespace {

using math::dvec3;
using motion_blur::EmbeddedMotionBlur;
using motion_blur::getMethod;
using motion_blur::HostDevice;
using motion_blur::HostImage;
using motion_blur::HostInputs;
using motion_blur::Method;
using motion_blur::MotionBlurSettings;

constexpr uint32_t kWidth = 96;
constexpr uint32_t kHeight = 64;

constexpr graph::OutsideUse kSampled{
    VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
    VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
    VK_ACCESS_2_SHADER_SAMPLED_READ_BIT};
constexpr graph::OutsideUse kCopied{
    VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
    VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT,
    VK_ACCESS_2_TRANSFER_READ_BIT};
constexpr graph::OutsideUse kWritten{
    VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
    VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT,
    VK_ACCESS_2_TRANSFER_WRITE_BIT};
constexpr graph::OutsideUse kNothing{
    VK_IMAGE_LAYOUT_UNDEFINED, VK_PIPELINE_STAGE_2_NONE, VK_ACCESS_2_NONE};

VkImageCopy wholeCopy(uint32_t width, uint32_t height) {
    VkImageCopy region{};
    region.srcSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    region.dstSubresource = region.srcSubresource;
    region.extent = {width, height, 1};
    return region;
}

void moveOn(
    VkCommandBuffer commands,
    VkImage image,
    const graph::OutsideUse& before,
    const graph::OutsideUse& after
) {
    VkImageMemoryBarrier2 barrier{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2};
    barrier.srcStageMask = before.stages;
    barrier.srcAccessMask = before.access;
    barrier.dstStageMask = after.stages;
    barrier.dstAccessMask = after.access;
    barrier.oldLayout = before.layout;
    barrier.newLayout = after.layout;
    barrier.image = image;
    barrier.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    VkDependencyInfo dependency{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
    dependency.imageMemoryBarrierCount = 1;
    dependency.pImageMemoryBarriers = &barrier;
    vkCmdPipelineBarrier2(commands, &dependency);
}

gpu::Image
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

/// A picture in half floats that is copied to where the CPU reads it.
class Picture {
  public:
    Picture(gpu::Device& device, const char* name)
        : mImage(makeImage(device, name, VK_FORMAT_R16G16B16A16_SFLOAT, kWidth, kHeight)),
          mPixels(device, name, kWidth * kHeight * 8, 0, gpu::MemoryUse::Readback) {}

    [[nodiscard]] VkImage handle() const { return mImage.handle(); }

    /// The image is as kCopied says.
    void recordReadback(VkCommandBuffer commands) const {
        VkBufferImageCopy region{};
        region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
        region.imageExtent = {kWidth, kHeight, 1};
        vkCmdCopyImageToBuffer(
            commands, mImage.handle(), kCopied.layout, mPixels.handle(), 1, &region
        );
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

    [[nodiscard]] image::Image read() const {
        image::Image picture(kWidth, kHeight, 4);
        const auto* texels = static_cast<const uint64_t*>(mPixels.mapped());
        for (size_t i = 0; i < size_t{kWidth} * kHeight; ++i) {
            const glm::vec4 value = glm::unpackHalf4x16(texels[i]);
            std::memcpy(&picture.pixels[4 * i], &value, sizeof(value));
        }
        return picture;
    }

  private:
    gpu::Image mImage;
    gpu::Buffer mPixels;
};

/// Takes the engine's G-buffer as a host would give its own: raw handles of images in the layouts
/// they happen to have. Blurs it into another picture and, a copy of it, in place; the frame goes
/// on with what it was.
class HostOfTheGBuffer : public render::PostEffect {
  public:
    HostOfTheGBuffer(
        gpu::Device& device, EmbeddedMotionBlur& blur, const MotionBlurSettings& settings
    )
        : mBlur(blur), mSettings(settings), output(device, "output"), inPlace(device, "in place") {}

    [[nodiscard]] std::string name() const override { return "host"; }

    [[nodiscard]] core::Decision ask(const render::ViewFacts&) const override {
        return {true, "it is looked at"};
    }

    void declare(render::PostContext& context) override {
        struct Data {
            graph::ImageHandle color, motionDepth, normal, entityId;
        };

        HostInputs inputs;
        inputs.width = context.facts.width;
        inputs.height = context.facts.height;
        inputs.rasterTime = context.facts.rasterTime;
        inputs.response = context.response;
        inputs.rays.frameConstants = context.frameConstants;
        if (context.rays) {
            inputs.rays.tlas = context.rays->tlas;
            inputs.rays.scene = context.rays->textures;
            inputs.rays.frameConstants = context.rays->frameConstants;
            inputs.rays.hasBlended = context.rays->hasBlended;
        }
        using graph::Access;
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
                builder.sideEffect();
            },
            [this, inputs, level](const Data& data, graph::PassContext& pass) {
                const auto give = [&](graph::ImageHandle image) {
                    return HostImage{pass.resources.image(image).handle(), kSampled, kSampled};
                };
                HostInputs given = inputs;
                given.color = give(data.color);
                given.motionDepth = give(data.motionDepth);
                given.normal = give(data.normal);
                given.entityId = give(data.entityId);
                if (level.isValid())
                    given.rays.tlasBuffer = pass.resources.buffer(level);
                recordBoth(pass.commands, given);
            }
        );
    }

  private:
    void recordBoth(VkCommandBuffer commands, HostInputs inputs) {
        inputs.output = {output.handle(), kNothing, kCopied};
        const core::Status other = mBlur.record(commands, 0, inputs, mSettings);
        ASSERT_TRUE(other.ok()) << other.error().message;
        output.recordReadback(commands);

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
        const core::Status same = mBlur.record(commands, 1, inputs, mSettings);
        ASSERT_TRUE(same.ok()) << same.error().message;
        inPlace.recordReadback(commands);
    }

    EmbeddedMotionBlur& mBlur;
    MotionBlurSettings mSettings;

  public:
    Picture output;
    Picture inPlace;
};

/// Two movers that cross before a wall, one of them near.
void build(test::SceneBuilder& scene) {
    scene.setPerspective(1.0);
    const auto wall = scene.addTextured(scene.addWaveTexture());
    const auto front = scene.addTextured(scene.addWaveTexture(32));
    scene.add(test::makeQuad(12.0, 8.0, wall), {.position = dvec3(0.0, 0.0, -6.0)});
    scene.add(
        test::makeQuad(1.2, 1.2, front),
        {.position = dvec3(0.2, 0.1, -3.0), .velocity = dvec3(1.0, 0.2, 0.0)}
    );
    scene.add(
        test::makeBox(dvec3(0.8), front),
        {.position = dvec3(-1.0, -0.4, -4.0), .angularVelocity = dvec3(0.0, 0.0, 1.0)}
    );
}

class Foreign : public test::GpuTest {
  protected:
    static HostDevice describeHost() {
        HostDevice host;
        host.physical = device().physical();
        host.device = device().handle();
        host.queueFamily = device().queueFamily();
        host.hasDebugUtils = true;
        return host;
    }

    static std::unique_ptr<EmbeddedMotionBlur> create(const HostDevice& host) {
        auto blur = EmbeddedMotionBlur::create(host);
        EXPECT_TRUE(blur.ok()) << blur.error().message;
        return blur.ok() ? std::move(blur).value() : nullptr;
    }

    /// Draws a frame with the host's blur before the plugin's, which must be the same.
    static void expectSameAsPlugin(HostDevice host, std::span<const Method* const> methods) {
        test::SceneBuilder scene;
        build(scene);
        render::Renderer renderer(device(), scene.world.assets);
        if (host.rayTier != gpu::RayTier::None)
            host.sceneLayout = renderer.scene().textureLayout();
        const auto blur = create(host);
        ASSERT_TRUE(blur);
        render::FrameRequest request;
        request.view.camera = scene.camera;
        scene::CameraShutter shutter;
        shutter.exposureSeconds = 0.5;
        shutter.response.shape = scene::ResponseShape::Triangle;
        request.view.exposure = scene::computeExposure(shutter, 0.0, scene::kStillFrameSeconds);
        request.view.width = kWidth;
        request.view.height = kHeight;
        const auto sharp = renderer.renderFrame(scene.world, request, {});
        ASSERT_TRUE(sharp.ok()) << sharp.error().message;
        request.intermediates = {"mask"};
        for (const Method* method : methods) {
            SCOPED_TRACE(method->name);
            MotionBlurSettings settings;
            settings.method = method;
            HostOfTheGBuffer foreign(device(), *blur, settings);
            motion_blur::MotionBlurPlugin plugin(device(), renderer.scene(), settings);
            const std::array<render::PostEffect*, 2> effects{&foreign, &plugin};
            const auto drawn = renderer.renderFrame(scene.world, request, effects);
            ASSERT_TRUE(drawn.ok()) << drawn.error().message;
            const image::Image& expected = drawn.value().color;
            EXPECT_FALSE(test::sameBits(expected, sharp.value().color)) << "nothing was blurred";
            EXPECT_TRUE(test::sameBits(foreign.output.read(), expected));
            EXPECT_TRUE(test::sameBits(foreign.inPlace.read(), expected));
            if (method == &getMethod("hybrid")) {
                EXPECT_GT(test::countSet(drawn.value().intermediates.at("mask")), 50u);
            }
        }
    }
};

TEST_F(Foreign, EachMethodWithoutRaysGivesTheBitsOfThePlugin) {
    std::vector<const Method*> methods;
    for (const Method* method : motion_blur::listMethods())
        if (!method->readsCamera && method->rays == motion_blur::RayNeed::None)
            methods.push_back(method);
    expectSameAsPlugin(describeHost(), methods);
}

TEST_F(Foreign, HybridGivesTheBitsOfThePlugin) {
    if (!device().hasRays())
        GTEST_SKIP() << "the device traces no rays";
    HostDevice host = describeHost();
    host.rayTier = device().info().rayTier;
    expectSameAsPlugin(host, std::array{&getMethod("hybrid")});
}

/// Pictures of the host that are cleared in each frame, and a command buffer of its own.
struct HostFrame {
    HostFrame(gpu::Device& device, uint32_t w, uint32_t h)
        : width(w), height(h),
          color(makeImage(device, "color", VK_FORMAT_R16G16B16A16_SFLOAT, w, h)),
          motionDepth(makeImage(device, "motion", VK_FORMAT_R32G32B32A32_SFLOAT, w, h)),
          output(makeImage(device, "output", VK_FORMAT_R16G16B16A16_SFLOAT, w, h)) {}

    [[nodiscard]] HostInputs inputs() const {
        HostInputs in;
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

MotionBlurSettings gather() {
    MotionBlurSettings settings;
    settings.method = &getMethod("gather");
    return settings;
}

// Validation finds whatever is destroyed or overwritten while a frame is in flight.
TEST_F(Foreign, FramesInFlightMayChangeTheirSize) {
    const auto blur = create(describeHost());
    ASSERT_TRUE(blur);
    std::array<gpu::Frame, 2> frames{gpu::Frame(device()), gpu::Frame(device())};
    gpu::LivingObjects small;
    gpu::LivingObjects last;
    for (uint32_t i = 0; i < 12; ++i) {
        const bool isLarge = i >= 4 && i < 8;
        const HostFrame host(device(), isLarge ? 120 : 40, isLarge ? 72 : 24);
        gpu::Frame& frame = frames[i % 2];
        frame.begin(); // waits for the one before the last
        host.recordClears(frame.commands());
        const core::Status done = blur->record(frame.commands(), i % 2, host.inputs(), gather());
        ASSERT_TRUE(done.ok()) << done.error().message;
        frame.submit();
        (i < 4 ? small : last) = blur->living();
    }
    for (gpu::Frame& frame : frames)
        frame.wait();
    EXPECT_GT(small.images, 0u);
    EXPECT_EQ(last, small) << "what the large pictures needed is gone";
}

TEST_F(Foreign, WhatResizingLeftOverGoesWhenItsFramesAreDone) {
    HostDevice description = describeHost();
    description.framesInFlight = 3;
    const auto blur = create(description);
    ASSERT_TRUE(blur);
    gpu::Frame frame(device());
    const auto draw = [&](uint32_t slot, uint32_t size) {
        const HostFrame host(device(), size, size);
        frame.begin();
        host.recordClears(frame.commands());
        EXPECT_TRUE(blur->record(frame.commands(), slot, host.inputs(), gather()).ok());
        frame.submit();
        frame.wait();
    };
    draw(0, 40);
    const gpu::LivingObjects one = blur->living();
    draw(1, 40); // not said to be done until below
    draw(0, 80);
    draw(0, 40);
    draw(0, 40);
    EXPECT_GT(blur->living().images, 2 * one.images) << "frame 1 may still use what was retired";
    blur->markDone(1);
    draw(0, 40);
    EXPECT_LE(blur->living().images, 2 * one.images);
}

void expectRefusal(const core::Status& status, const std::string& part) {
    ASSERT_FALSE(status.ok()) << "expected: " << part;
    EXPECT_NE(status.error().message.find(part), std::string::npos) << status.error().message;
}

class ForeignRefusals : public Foreign {
  protected:
    void SetUp() override {
        Foreign::SetUp();
        if (IsSkipped() || HasFatalFailure())
            return;
        mBlur = create(describeHost());
        mHost.emplace(device(), 40, 24);
        mFrame.emplace(device());
        inputs = mHost->inputs();
        settings = gather();
    }

    void TearDown() override {
        mFrame.reset();
        mHost.reset();
        mBlur.reset();
        Foreign::TearDown();
    }

    core::Status record(uint32_t frame = 0) {
        mFrame->begin();
        mHost->recordClears(mFrame->commands());
        const core::Status status = mBlur->record(mFrame->commands(), frame, inputs, settings);
        mFrame->submit();
        mFrame->wait();
        return status;
    }

    HostInputs inputs;
    MotionBlurSettings settings;
    std::unique_ptr<EmbeddedMotionBlur> mBlur;
    std::optional<HostFrame> mHost;
    std::optional<gpu::Frame> mFrame;
};

TEST_F(ForeignRefusals, EachBadInputIsNamed) {
    const HostInputs good = inputs;
    ASSERT_TRUE(record().ok());
    expectRefusal(record(2), "frame is 2, framesInFlight 2");
    expectRefusal(mBlur->record(VK_NULL_HANDLE, 0, inputs, settings), "command buffer is null");
    const auto refuse = [&](auto&& change, const std::string& part) {
        inputs = good;
        change();
        expectRefusal(record(), part);
    };
    refuse([&] { inputs.width = 0; }, "the size is 0 x 24");
    refuse([&] { inputs.height = 32769; }, "the size is 40 x 32769");
    refuse([&] { inputs.rasterTime = -0.1; }, "rasterTime is -0.1");
    refuse(
        [&] { inputs.rasterTime = std::numeric_limits<double>::quiet_NaN(); }, "rasterTime is nan"
    );
    refuse([&] { inputs.color.image = VK_NULL_HANDLE; }, "color.image is null");
    refuse([&] { inputs.motionDepth.image = VK_NULL_HANDLE; }, "motionDepth.image is null");
    refuse(
        [&] { inputs.color.before.layout = VK_IMAGE_LAYOUT_UNDEFINED; },
        "color.before.layout is undefined"
    );
    refuse([&] { inputs.output.image = inputs.color.image; }, "leave output.image null");
    refuse(
        [&] { inputs.motionDepth.image = inputs.color.image; }, "motionDepth.image is color.image"
    );
    inputs = good;
    EXPECT_TRUE(record().ok());
}

TEST_F(ForeignRefusals, EachMethodThatCannotRunIsNamed) {
    settings.sampleCount = 0;
    expectRefusal(record(), "sampleCount");
    settings = gather();
    settings.method = &getMethod("denoised");
    expectRefusal(record(), "denoised");
    settings.method = &getMethod("hybrid");
    expectRefusal(record(), "the method hybrid needs rays");
}

TEST_F(ForeignRefusals, EachBadHostIsNamed) {
    const auto refuse = [](auto&& change, const std::string& part) {
        HostDevice host = describeHost();
        change(host);
        const auto made = EmbeddedMotionBlur::create(host);
        ASSERT_FALSE(made.ok()) << "expected: " << part;
        EXPECT_NE(made.error().message.find(part), std::string::npos) << made.error().message;
    };
    refuse([](HostDevice& host) { host.physical = VK_NULL_HANDLE; }, "physical is null");
    refuse([](HostDevice& host) { host.device = VK_NULL_HANDLE; }, "device is null");
    refuse([](HostDevice& host) { host.framesInFlight = 0; }, "framesInFlight is 0");
    refuse([](HostDevice& host) { host.framesInFlight = 65; }, "framesInFlight is 65");
    refuse([](HostDevice& host) { host.queueFamily = 99; }, "queueFamily 99");
    refuse([](HostDevice& host) { host.rayTier = gpu::RayTier::RayQuery; }, "sceneLayout is null");
}

TEST_F(ForeignRefusals, RaysWithoutTheirTablesAreNamed) {
    if (!device().hasRays())
        GTEST_SKIP() << "the device traces no rays";
    test::SceneBuilder scene;
    render::Renderer renderer(device(), scene.world.assets);
    HostDevice host = describeHost();
    host.rayTier = device().info().rayTier;
    host.sceneLayout = renderer.scene().textureLayout();
    mBlur = create(host);
    settings.method = &getMethod("hybrid");
    expectRefusal(record(), "normal.image is null");
    inputs.normal = {mHost->output.handle(), kSampled, kSampled};
    inputs.output = {};
    expectRefusal(record(), "entityId.image is null");
    const gpu::Image entityId = makeImage(device(), "entity id", VK_FORMAT_R32_UINT, 40, 24);
    inputs.entityId = {entityId.handle(), kSampled, kSampled};
    expectRefusal(record(), "rays.frameConstants is 0");
    inputs.rays.frameConstants = 4096;
    // Nothing looks at it: it is refused for what it lacks.
    inputs.rays.tlas = reinterpret_cast<VkAccelerationStructureKHR>(uintptr_t{1});
    expectRefusal(record(), "rays.tlasBuffer is null");
}

} // namespace
} // namespace shutter
