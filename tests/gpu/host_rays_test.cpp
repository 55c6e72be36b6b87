// SPDX-License-Identifier: MIT
// Methods with rays: `hybrid` and `adaptive` with a host's own, the effect's requests and its use
// of the answers; and ids that have no row in the tables of a host that has ours traced.
#include "spirv/answer_samples.comp.h"
#include "spirv/motion_blur/reveal.comp.h"

#include "engine/image/metrics.h"
#include "engine/scene/lens.h"
#include "game/replay/replay_run.h"
#include "modules/motion_blur/params.h"
#include "shaders/motion_blur/hybrid_shared.h"
#include "shaders/render/scene_shared.h"
#include "tests/gpu/gbuffer_host.h"
#include "tests/support/temp_folder.h"

#include <array>
#include <cstdio>
#include <cstring>
#include <deque>
#include <memory>
#include <optional>
#include <vector>

namespace shutter {
namespace {

using motion_blur::HostInputs;
using motion_blur::MotionBlurSettings;
using motion_blur::RevealTask;
using motion_blur::SampleTask;
using test::BlurStage;
using test::settingsOf;
using test::StagedFrame;

constexpr math::uvec2 kRaySize = test::kStageSize;
constexpr uint32_t kRayInstants = 7;
constexpr double kRayYFov = 1.0; ///< radians

/// Rays of the host's: a compute shader with the host's tables of its scene. The engine's own
/// reveal, so that the picture differs from the engine's.
class RevealHost {
  public:
    RevealHost(gpu::Device& device, VkDescriptorSetLayout sceneLayout)
        : mNearest(device.nearestSampler()), mShader(device, describe(sceneLayout)) {}

    /// Answers with rays through the scene of `inputs`, which then has none.
    void take(motion_blur::HostInputs& inputs) {
        const motion_blur::HostRays rays = std::exchange(inputs.rays, {});
        inputs.reveal.record = [this, rays, &inputs](const RevealTask& task) {
            record(rays, inputs, task);
        };
    }

    uint32_t calls = 0;

  private:
    static gpu::ComputePipelineDesc describe(VkDescriptorSetLayout sceneLayout) {
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
        return desc;
    }

    void record(
        const motion_blur::HostRays& rays,
        const motion_blur::HostInputs& inputs,
        const RevealTask& task
    ) {
        ++calls;
        motion_blur::PassParams params =
            motion_blur::resolve(settingsOf("hybrid"), kRaySize.x, kRaySize.y, inputs.rasterTime);
        params.response = gpu::splitAddress(inputs.response);
        auto own = params.getMethod<shader::HybridParams>();
        own.frame = gpu::splitAddress(rays.frameConstants);
        params.setMethod(own);
        constexpr VkFormat kHalf = VK_FORMAT_R16G16B16A16_SFLOAT;
        constexpr VkFormat kFloat = VK_FORMAT_R32G32B32A32_SFLOAT;
        gpu::BindingList bindings;
        const auto adopt = [&](VkImage image, VkFormat format, VkImageUsageFlags usage) -> auto& {
            return mShader.adopt(image, {kRaySize.x, kRaySize.y}, format, usage);
        };
        const auto read = [&](VkImage image, VkFormat format) {
            bindings.sampled(adopt(image, format, VK_IMAGE_USAGE_SAMPLED_BIT).view(), mNearest);
        };
        read(inputs.color.image, kHalf);
        read(inputs.motionDepth.image, kFloat);
        read(inputs.entityId.image, VK_FORMAT_R32_UINT);
        read(inputs.color.image, kHalf); // the mask, which no pixel shares a ray by
        const auto write = [&](VkImage image, VkFormat format) {
            bindings.storage(adopt(image, format, VK_IMAGE_USAGE_STORAGE_BIT));
        };
        write(task.color.image, kHalf);
        write(task.motionDepth.image, kFloat);
        write(task.entityId.image, VK_FORMAT_R32_UINT);
        bindings.buffer(task.list).accelerationStructure(rays.tlas);
        mShader.bind(task.commands, bindings, params, rays.scene);
        vkCmdDispatchIndirect(task.commands, task.groups, 0);
    }

    VkSampler mNearest;
    test::HostShader mShader;
};

/// Rays of the host's through its own tables of the scene.
class SampleHost {
  public:
    SampleHost(gpu::Device& device, VkDescriptorSetLayout sceneLayout)
        : mShader(
              device,
              {.name = "the host's rays",
               .spirv = answer_samples_comp,
               .interface =
                   {{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                     VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                     VK_DESCRIPTOR_TYPE_ACCELERATION_STRUCTURE_KHR,
                     VK_DESCRIPTOR_TYPE_STORAGE_BUFFER},
                    sizeof(Push),
                    sceneLayout}}
          ) {}

    void answer(const graph::TimedRays& rays, const SampleTask& task) {
        ++calls;
        gpu::BindingList bindings;
        bindings.buffer(task.list)
            .buffer(task.answers)
            .accelerationStructure(rays.tlas)
            .buffer(task.lensPlaces ? task.lensPlaces : task.answers);
        const Push push{
            gpu::splitAddress(rays.frameConstants),
            gpu::splitAddress(rays.timedConstants),
            task.lensPlaces ? focusDistance : 0.0f};
        mShader.bind(task.commands, bindings, push, rays.textures);
        vkCmdDispatchIndirect(task.commands, task.groups, 0);
    }

    uint32_t calls = 0;
    float focusDistance = 0.0f; ///< of the lens, if there is one

  private:
    struct Push {
        math::uvec2 frame;
        math::uvec2 timed;
        float focusDistance;
    };

    test::HostShader mShader;
};

class OwnRays : public test::StagedTest {
  protected:
    void SetUp() override {
        StagedTest::SetUp();
        if (IsSkipped() || HasFatalFailure())
            return;
        if (!device().hasRayQuery())
            GTEST_SKIP() << "the device traces no rays in compute shaders";
        mScene.setPerspective(kRayYFov);
        const auto wall = mScene.addTextured(mScene.addWaveTexture(), true);
        const auto front = mScene.addTextured(mScene.addWaveTexture(32), true);
        mScene.add(test::makeQuad(12.0, 8.0, wall), {.position = {0.0, 0.0, -6.0}});
        mScene.add(
            test::makeQuad(1.2, 1.2, front),
            {.position = {0.2, 0.1, -3.0}, .velocity = {3.0, 0.6, 0.0}}
        );
    }

    [[nodiscard]] motion_blur::HostDevice hostOfSuite() const override {
        motion_blur::HostDevice host = describeHost(); // of no ray tier
        host.measures = true;
        return host;
    }

    /// The same frame by the plugin's adaptive, and by a host whose method may be another.
    /// \param isAnswered by the host's rays
    StagedFrame drawSamples(
        const MotionBlurSettings& plugins, const MotionBlurSettings& hosts, bool isAnswered = true
    ) {
        BlurStage stage(device(), mScene, *mBlur, blurOfC(), hosts, plugins);
        SampleHost rays(device(), stage.renderer.scene().textureLayout());
        test::MotionDescriber describer(kRayInstants);
        stage.declareMotion(describer);
        stage.shutter.exposureSeconds = 0.25;
        const auto* lens = mScene.world.registry.find<scene::CameraLens>(mScene.camera);
        stage.request.view.usesLens = lens != nullptr;
        rays.focusDistance = lens ? float(lens->focusDistance) : 0.0f;
        stage.host.changeInputs = [&](const render::PictureContext& context, HostInputs& inputs) {
            std::optional<graph::TimedRays> timed;
            if (context.timedRays)
                timed = *context.timedRays;
            inputs.samples.record = [&rays, timed, isAnswered](const SampleTask& task) {
                if (isAnswered && timed)
                    rays.answer(*timed, task);
            };
            if (lens)
                inputs.motion.lens = {
                    .radius = scene::computeLensRadius(*lens, kRayYFov),
                    .focusDistance = lens->focusDistance};
        };
        StagedFrame drawn = stage.draw();
        EXPECT_EQ(rays.calls, isAnswered ? 3u : 0u) << "once a recording";
        const auto report = stage.blur->report(0);
        EXPECT_TRUE(report.ok()) << report.error().message;
        mCounters = report.value().counters;
        return drawn;
    }

    static MotionBlurSettings adaptive(float raysPerPixel) {
        MotionBlurSettings settings = settingsOf("adaptive", kRayInstants);
        settings.raysPerPixel = raysPerPixel;
        settings.history = false; // of a single frame the host has none
        return settings;
    }

    test::SceneBuilder mScene;
    motion_blur::Counters mCounters; ///< of the host's
};

TEST_F(OwnRays, RevealsOfTheHostGiveTheBitsOfOursAndAreInDumps) {
    const MotionBlurSettings settings = settingsOf("hybrid");
    BlurStage stage(device(), mScene, *mBlur, blurOfC(), settings, settings);
    RevealHost rays(device(), stage.renderer.scene().textureLayout());
    stage.host.takeRays = [&](HostInputs& inputs) { rays.take(inputs); };
    stage.request.intermediates = {"mask"};
    const test::TempFolder folder;
    replay::ReplayOptions options;
    options.folder = folder.path() / "dump";
    ASSERT_TRUE(stage.blur->dump(options.folder, 2).ok());
    const StagedFrame drawn = stage.draw();
    EXPECT_EQ(rays.calls, 3u) << "once a recording";
    EXPECT_GT(test::countSet(drawn.result.intermediates.at("mask")), 50u);
    expectSame(drawn);
    ASSERT_TRUE(stage.blur->markDone(0).ok() && stage.blur->markDone(1).ok());
    testing::internal::CaptureStdout();
    const core::Status replayed = replay::replay(options, device());
    std::fflush(stdout);
    EXPECT_EQ(
        testing::internal::GetCapturedStdout(),
        "frame_0000: hybrid: the host's picture, bit for bit\n"
        "frame_0001: hybrid: the host's picture, bit for bit\n"
    );
    ASSERT_TRUE(replayed.ok()) << replayed.error().message;
}

TEST_F(OwnRays, SamplesOfTheHostGiveTheBitsOfOurs) {
    const MotionBlurSettings all = adaptive(float(kRayInstants));
    const StagedFrame drawn = drawSamples(all, all);
    const uint64_t traced = drawn.result.statistics.counters.at("rays traced");
    EXPECT_GT(traced, 100u);
    EXPECT_EQ(mCounters.at("rays traced"), traced);
    expectSame(drawn);
}

TEST_F(OwnRays, SamplesOfTheHostThroughALensAreOurs) {
    mScene.world.registry.add(
        mScene.camera, scene::CameraLens{.fStop = 0.05, .focusDistance = 5.0}
    );
    MotionBlurSettings resolved = settingsOf("resolved", kRayInstants);
    resolved.history = false;
    const MotionBlurSettings all = adaptive(float(kRayInstants));
    const image::Image lookedUp = drawSamples(resolved, all, false).result.color;
    const StagedFrame drawn = drawSamples(all, all);
    const uint64_t traced = drawn.result.statistics.counters.at("rays traced");
    EXPECT_GT(traced, 1000u);
    EXPECT_EQ(mCounters.at("rays traced"), traced);
    EXPECT_LT(image::computePsnr(lookedUp, drawn.result.color), 45.0) << "rays change the picture";
    EXPECT_GT(image::computePsnr(drawn.output, drawn.result.color), 60.0);
    EXPECT_TRUE(test::sameBits(drawn.byC, drawn.output));
}

TEST_F(OwnRays, AShortListHoldsAllSamplesThatWeTrace) {
    // Samples are traced at random, so that more may be than the limit.
    constexpr uint32_t kLimit = 10;
    MotionBlurSettings few = adaptive((kLimit + 0.5f) / float(kRaySize.x * kRaySize.y));
    few.sampleCount = 28;
    const StagedFrame drawn = drawSamples(few, few);
    const uint64_t traced = drawn.result.statistics.counters.at("rays traced");
    EXPECT_GT(traced, kLimit + 1);
    EXPECT_EQ(mCounters.at("rays traced"), traced);
    EXPECT_GT(image::computePsnr(drawn.output, drawn.result.color), 60.0);
}

TEST_F(OwnRays, AHostThatAnswersNothingGetsResolved) {
    MotionBlurSettings hosts = adaptive(float(kRayInstants));
    MotionBlurSettings plugins = settingsOf("resolved", kRayInstants);
    plugins.history = false;
    hosts.uniformMotionPx = plugins.uniformMotionPx = 0.0f; // each pixel searches individually
    const StagedFrame drawn = drawSamples(plugins, hosts, false);
    EXPECT_EQ(mCounters.at("rays traced"), 0u);
    EXPECT_TRUE(test::sameBits(drawn.output, drawn.result.color));
}

using EmbeddedIds = test::EmbeddedTest;

TEST_F(EmbeddedIds, IdsWithoutRowsRevealNothingAndAHitEntityMayHaveNone) {
    if (!device().hasRays())
        GTEST_SKIP() << "the device traces no rays";
    constexpr uint32_t kRows = 3; // the wall's is the last
    test::SceneBuilder scene;
    test::buildMovers(scene);
    motion_blur::HostDevice described = describeHost();
    described.rayTier = device().info().rayTier;
    // One of the renderer's own effects has to request rays: the plugin.
    BlurStage stage(device(), scene, described, settingsOf("hybrid"));
    std::deque<gpu::Buffer> tables;
    // Draws a host whose table ends after `rowCount` rows: later rows are invalid.
    const auto draw = [&](uint32_t rowCount) {
        stage.host.changeInputs =
            [&, rowCount](const render::PictureContext& context, HostInputs& inputs) {
                EXPECT_EQ(context.frame.entities.size(), kRows);
                std::vector<shader::EntityRow> rows = context.frame.entities;
                for (uint32_t i = rowCount; i < rows.size(); ++i)
                    std::memset(&rows[i], 0xFF, sizeof(rows[i]));
                const auto upload = [&](const void* data, size_t bytes) {
                    gpu::Buffer& table = tables.emplace_back(
                        device(),
                        "host",
                        bytes,
                        VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
                        gpu::MemoryUse::Stream
                    );
                    table.writeBytes(data, bytes, 0);
                    return table.address();
                };
                shader::FrameConstants constants = *context.constantValues;
                constants.entities =
                    gpu::splitAddress(upload(rows.data(), rows.size() * sizeof(rows[0])));
                constants.entityCount = rowCount;
                inputs.rays.frameConstants = upload(&constants, sizeof(constants));
            };
        return stage.draw().output;
    };
    const image::Image all = draw(kRows);
    const image::Image none = draw(0);
    const image::Image withoutWall = draw(kRows - 1); // which rays behind the movers meet
    EXPECT_TRUE(test::allFinite(withoutWall));
    EXPECT_FALSE(test::sameBits(withoutWall, all));
    stage.host.settings.revealTraversal = motion_blur::RevealTraversal::Stepping;
    stage.host.settings.recursionLimit = 1;
    const image::Image kept = draw(kRows); // which reveals nothing
    EXPECT_FALSE(test::sameBits(all, kept)) << "rays reveal something";
    EXPECT_TRUE(test::sameBits(none, kept));
}

} // namespace
} // namespace shutter
