// SPDX-License-Identifier: MIT
// `hybrid` with a host's own rays: what the effect asks for and what it makes of the answer.
#include "spirv/motion_blur/reveal.comp.h"

#include "engine/gpu/frame.h"
#include "engine/render/renderer.h"
#include "game/replay/replay_run.h"
#include "modules/motion_blur/params.h"
#include "modules/motion_blur/plugin/motion_blur_plugin.h"
#include "shaders/motion_blur/hybrid_shared.h"
#include "tests/gpu/embedding_host.h"
#include "tests/gpu/gbuffer_host.h"
#include "tests/kit/scene_builder.h"
#include "tests/support/picture.h"

#include <fmt/format.h>

#include <array>
#include <cstdio>
#include <deque>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <unistd.h>
#include <vector>

namespace shutter {
namespace {

using math::dvec3;
using motion_blur::MotionBlurSettings;
using motion_blur::RevealTask;
using test::HostOfTheGBuffer;

constexpr uint32_t kWidth = 96;
constexpr uint32_t kHeight = 64;

MotionBlurSettings hybrid() {
    MotionBlurSettings settings;
    settings.method = &motion_blur::getMethod("hybrid");
    return settings;
}

/// Rays of the host's: a compute shader with the host's tables of its scene. The engine's own
/// reveal, so that the picture can be told from the engine's.
class RayHost {
  public:
    RayHost(gpu::Device& device, VkDescriptorSetLayout sceneLayout) : mDevice(device) {
        gpu::ComputePipelineDesc desc;
        desc.name = "the host's rays";
        desc.spirv = motion_blur_reveal_comp;
        desc.interface.bindings.assign(4, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER);
        desc.interface.bindings.insert(
            desc.interface.bindings.end(), 3, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE
        );
        desc.interface.bindings.push_back(VK_DESCRIPTOR_TYPE_STORAGE_BUFFER);
        desc.interface.bindings.push_back(VK_DESCRIPTOR_TYPE_ACCELERATION_STRUCTURE_KHR);
        desc.interface.sceneLayout = sceneLayout;
        desc.interface.pushConstantBytes = sizeof(motion_blur::PassParams);
        desc.specialization = {0u};
        mPipeline.emplace(device, desc);
    }

    /// Answers with rays through the scene of `inputs`, which then has none.
    void take(motion_blur::HostInputs& inputs) {
        const motion_blur::HostRays rays = std::exchange(inputs.rays, {});
        inputs.reveal.record = [this, rays, &inputs](const RevealTask& task) {
            record(rays, inputs, task);
        };
    }

    uint32_t calls = 0;

  private:
    gpu::Image adopt(VkImage image, VkFormat format, VkImageUsageFlags usage) {
        return gpu::Image::adopt(mDevice, "host's", image, {kWidth, kHeight, format, usage});
    }

    void record(
        const motion_blur::HostRays& rays,
        const motion_blur::HostInputs& inputs,
        const RevealTask& task
    ) {
        ++calls;
        motion_blur::PassParams params =
            motion_blur::resolve(hybrid(), kWidth, kHeight, inputs.rasterTime);
        params.response = gpu::splitAddress(inputs.response);
        auto own = params.getMethod<shader::HybridParams>();
        own.frame = gpu::splitAddress(rays.frameConstants);
        params.setMethod(own);
        constexpr VkImageUsageFlags kRead = VK_IMAGE_USAGE_SAMPLED_BIT;
        constexpr VkImageUsageFlags kWrite = VK_IMAGE_USAGE_STORAGE_BIT;
        constexpr VkFormat kHalf = VK_FORMAT_R16G16B16A16_SFLOAT;
        constexpr VkFormat kFloat = VK_FORMAT_R32G32B32A32_SFLOAT;
        const auto keep = [&](VkImage image, VkFormat format, VkImageUsageFlags usage) {
            return mImages.emplace_back(adopt(image, format, usage)).view();
        };
        const VkImageView color = keep(inputs.color.image, kHalf, kRead);
        const VkImageView motionDepth = keep(inputs.motionDepth.image, kFloat, kRead);
        const VkImageView ids = keep(inputs.entityId.image, VK_FORMAT_R32_UINT, kRead);
        gpu::BindingList bindings;
        bindings.sampled(color, mDevice.nearestSampler())
            .sampled(motionDepth, mDevice.nearestSampler())
            .sampled(ids, mDevice.nearestSampler())
            .sampled(color, mDevice.nearestSampler()); // the mask, which no pixel shares a ray by
        keep(task.color.image, kHalf, kWrite);
        bindings.storage(mImages.back());
        keep(task.motionDepth.image, kFloat, kWrite);
        bindings.storage(mImages.back());
        keep(task.entityId.image, VK_FORMAT_R32_UINT, kWrite);
        bindings.storage(mImages.back());
        bindings.buffer(task.list).accelerationStructure(rays.tlas);
        gpu::Frame& frame = *mFrames.emplace_back(gpu::Frame::createForHost(mDevice));
        frame.beginIn(task.commands);
        frame.bind(*mPipeline, bindings, &params, sizeof(params), rays.scene);
        vkCmdDispatchIndirect(task.commands, task.groups, 0);
    }

    gpu::Device& mDevice;
    std::optional<gpu::Pipeline> mPipeline;
    std::deque<gpu::Image> mImages; ///< until the GPU is done
    std::vector<std::unique_ptr<gpu::Frame>> mFrames;
};

class OwnReveal : public test::EmbeddedTest {};

TEST_F(OwnReveal, RaysOfTheHostGiveTheBitsOfOurs) {
    if (!device().hasRayQuery())
        GTEST_SKIP() << "the device traces no rays in compute shaders";
    test::SceneBuilder scene;
    scene.setPerspective(1.0);
    const auto wall = scene.addTextured(scene.addWaveTexture());
    scene.add(test::makeQuad(12.0, 8.0, wall), {.position = dvec3(0.0, 0.0, -6.0)});
    scene.add(
        test::makeQuad(1.2, 1.2, scene.addTextured(scene.addWaveTexture(32))),
        {.position = dvec3(0.2, 0.1, -3.0), .velocity = dvec3(1.0, 0.2, 0.0)}
    );
    render::Renderer renderer(device(), scene.world.assets);
    motion_blur::HostDevice described =
        describeHost(); // of no ray tier: they are the host's affair
    described.framesInFlight = 2;
    const auto blur = create(described);
    ASSERT_TRUE(blur);
    RayHost rays(device(), renderer.scene().textureLayout());
    render::FrameRequest request;
    request.view.camera = scene.camera;
    scene::CameraShutter shutter;
    shutter.exposureSeconds = 0.5;
    request.view.exposure = scene::computeExposure(shutter, 0.0, scene::kStillFrameSeconds);
    request.view.width = kWidth;
    request.view.height = kHeight;
    request.intermediates = {"mask"};
    const auto folder =
        std::filesystem::temp_directory_path() / fmt::format("own_reveal_{}", ::getpid());
    ASSERT_TRUE(blur->dump(folder, 2).ok());
    HostOfTheGBuffer host(device(), *blur, hybrid(), {kWidth, kHeight});
    const test::BlurOfC c(device());
    host.blurOfC = c.blur;
    host.takeRays = [&](motion_blur::HostInputs& inputs) { rays.take(inputs); };
    motion_blur::MotionBlurPlugin plugin(device(), renderer.scene(), hybrid());
    const std::array<render::PostEffect*, 2> effects{&host, &plugin};
    const auto drawn = renderer.renderFrame(scene.world, request, effects);
    ASSERT_TRUE(drawn.ok()) << drawn.error().message;
    EXPECT_EQ(rays.calls, 3u) << "once a recording";
    EXPECT_GT(test::countSet(drawn.value().intermediates.at("mask")), 50u);
    EXPECT_TRUE(test::sameBits(host.output.read(), drawn.value().color));
    EXPECT_TRUE(test::sameBits(host.inPlace.read(), drawn.value().color));
    EXPECT_TRUE(test::sameBits(host.byC.read(), drawn.value().color));

    // What the rays found is in the dump, too.
    ASSERT_TRUE(blur->markDone(0).ok());
    ASSERT_TRUE(blur->markDone(1).ok());
    replay::ReplayOptions options;
    options.folder = folder;
    testing::internal::CaptureStdout();
    const core::Status replayed = replay::replay(options, device());
    std::fflush(stdout);
    const std::string said = testing::internal::GetCapturedStdout();
    std::filesystem::remove_all(folder);
    ASSERT_TRUE(replayed.ok()) << replayed.error().message;
    EXPECT_EQ(
        said,
        "frame_0000: hybrid: the host's picture, bit for bit\n"
        "frame_0001: hybrid: the host's picture, bit for bit\n"
    );
}

} // namespace
} // namespace shutter
