// SPDX-License-Identifier: MIT
// `adaptive` with a host's own rays: what the effect asks for and what it makes of the answers.
#include "spirv/answer_samples.comp.h"

#include "engine/gpu/frame.h"
#include "engine/image/metrics.h"
#include "engine/render/renderer.h"
#include "modules/motion_blur/plugin/motion_blur_plugin.h"
#include "tests/gpu/embedding_host.h"
#include "tests/gpu/gbuffer_host.h"
#include "tests/gpu/motion_teller.h"
#include "tests/kit/scene_builder.h"
#include "tests/support/picture.h"

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace shutter {
namespace {

using math::dvec3;
using motion_blur::HostInputs;
using motion_blur::MotionBlurSettings;
using motion_blur::SampleTask;

constexpr uint32_t kWidth = 96;
constexpr uint32_t kHeight = 64;
constexpr uint32_t kInstants = 7;

MotionBlurSettings settingsOf(const char* method, float raysPerPixel) {
    MotionBlurSettings settings;
    settings.method = &motion_blur::getMethod(method);
    settings.sampleCount = kInstants;
    settings.raysPerPixel = raysPerPixel;
    settings.history = false; // of a single frame the host has none
    return settings;
}

/// Rays of the host's through its own tables of the scene.
class RayHost {
  public:
    RayHost(gpu::Device& device, VkDescriptorSetLayout sceneLayout) : mDevice(device) {
        gpu::ComputePipelineDesc desc;
        desc.name = "the host's rays";
        desc.spirv = answer_samples_comp;
        desc.interface.bindings = {
            VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
            VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
            VK_DESCRIPTOR_TYPE_ACCELERATION_STRUCTURE_KHR};
        desc.interface.sceneLayout = sceneLayout;
        desc.interface.pushConstantBytes = 16;
        mPipeline.emplace(device, desc);
    }

    void answer(const graph::TimedRays& rays, const SampleTask& task) {
        ++calls;
        const std::array<math::uvec2, 2> push{
            gpu::splitAddress(rays.frameConstants), gpu::splitAddress(rays.timedConstants)};
        gpu::BindingList bindings;
        bindings.buffer(task.list).buffer(task.answers).accelerationStructure(rays.tlas);
        gpu::Frame& frame = *mFrames.emplace_back(gpu::Frame::createForHost(mDevice));
        frame.beginIn(task.commands);
        frame.bind(*mPipeline, bindings, push.data(), sizeof(push), rays.textures);
        vkCmdDispatchIndirect(task.commands, task.groups, 0);
    }

    uint32_t calls = 0;

  private:
    gpu::Device& mDevice;
    std::optional<gpu::Pipeline> mPipeline;
    std::vector<std::unique_ptr<gpu::Frame>> mFrames; ///< until the GPU is done
};

struct Drawn {
    image::Image plugin;
    image::Image host;
    image::Image inPlace;
    image::Image byC;
    motion_blur::Counters counters; ///< of the host's
    uint64_t pluginRays = 0;
};

class OwnSamples : public test::EmbeddedTest {
  protected:
    void SetUp() override {
        EmbeddedTest::SetUp();
        if (IsSkipped() || HasFatalFailure())
            return;
        if (!device().hasRayQuery())
            GTEST_SKIP() << "the device traces no rays in compute shaders";
        scene.setPerspective(1.0);
        const auto wall = scene.addTextured(scene.addWaveTexture(), true);
        scene.add(test::makeQuad(12.0, 8.0, wall), {.position = dvec3(0.0, 0.0, -6.0)});
        scene.add(
            test::makeQuad(1.2, 1.2, scene.addTextured(scene.addWaveTexture(32), true)),
            {.position = dvec3(0.2, 0.1, -3.0), .velocity = dvec3(3.0, 0.6, 0.0)}
        );
    }

    /// The same frame by the plugin's adaptive, and by a host whose method may be another.
    /// \param isAnswered by the host's rays
    Drawn draw(
        const MotionBlurSettings& plugins, const MotionBlurSettings& hosts, bool isAnswered = true
    ) {
        render::Renderer renderer(device(), scene.world.assets);
        motion_blur::HostDevice described = describeHost();
        described.measures = true;
        const auto blur = create(described);
        RayHost rays(device(), renderer.scene().textureLayout());
        test::Teller teller(kInstants);
        test::HostOfTheGBuffer host(device(), *blur, hosts, {kWidth, kHeight});
        const test::BlurOfC c(device());
        host.blurOfC = c.blur;
        host.describeMotion = [&](const render::PostContext& context, auto& motion) {
            teller.tell(scene.world, context, motion);
        };
        host.changeInputs = [&](const render::PostContext& context, HostInputs& inputs) {
            std::optional<graph::TimedRays> timed;
            if (context.timedRays)
                timed = *context.timedRays;
            inputs.samples.record = [&rays, timed, isAnswered](const SampleTask& task) {
                if (isAnswered && timed)
                    rays.answer(*timed, task);
            };
        };
        render::FrameRequest request;
        request.view.camera = scene.camera;
        scene::CameraShutter shutter;
        shutter.exposureSeconds = 0.25;
        request.view.exposure = scene::computeExposure(shutter, 0.0, scene::kStillFrameSeconds);
        request.view.width = kWidth;
        request.view.height = kHeight;
        motion_blur::MotionBlurPlugin plugin(device(), renderer.scene(), plugins);
        const std::array<render::PostEffect*, 2> effects{&host, &plugin};
        auto drawn = renderer.renderFrame(scene.world, request, effects);
        EXPECT_TRUE(drawn.ok()) << drawn.error().message;
        EXPECT_EQ(
            rays.calls, isAnswered && hosts.method->rays != motion_blur::RayNeed::None ? 3u : 0u
        );
        const auto report = blur->report(0);
        EXPECT_TRUE(report.ok()) << report.error().message;
        const auto& counters = drawn.value().statistics.counters;
        const auto traced = counters.find("rays traced");
        return {
            drawn.value().color,
            host.output.read(),
            host.inPlace.read(),
            host.byC.read(),
            report.value().counters,
            traced == counters.end() ? 0 : traced->second};
    }

    test::SceneBuilder scene;
};

TEST_F(OwnSamples, RaysOfTheHostGiveTheBitsOfOurs) {
    const MotionBlurSettings all = settingsOf("adaptive", float(kInstants));
    const Drawn drawn = draw(all, all);
    EXPECT_GT(drawn.pluginRays, 100u);
    EXPECT_EQ(drawn.counters.at("rays traced"), drawn.pluginRays);
    EXPECT_TRUE(test::sameBits(drawn.host, drawn.plugin));
    EXPECT_TRUE(test::sameBits(drawn.inPlace, drawn.plugin));
    EXPECT_TRUE(test::sameBits(drawn.byC, drawn.plugin));
}

TEST_F(OwnSamples, AShortListIsNeverExceededAndHoldsTheSamplesThatWeTrace) {
    const MotionBlurSettings few = settingsOf("adaptive", 0.05f);
    const Drawn drawn = draw(few, few);
    const auto limit = uint64_t(0.05 * kWidth * kHeight);
    EXPECT_LE(drawn.counters.at("rays traced"), limit);
    EXPECT_GT(drawn.counters.at("rays traced"), limit / 2);
    // Which samples are traced is left to chance: a list is full where the engine goes on.
    EXPECT_GT(image::computePsnr(drawn.host, drawn.plugin), 50.0);
}

TEST_F(OwnSamples, AHostThatAnswersNothingGetsResolved) {
    MotionBlurSettings adaptive = settingsOf("adaptive", float(kInstants));
    MotionBlurSettings resolved = settingsOf("resolved", 0.0f);
    adaptive.uniformMotionPx = resolved.uniformMotionPx = 0.0f; // each pixel looks for itself
    const Drawn drawn = draw(resolved, adaptive, false);
    EXPECT_EQ(drawn.counters.at("rays traced"), 0u);
    EXPECT_TRUE(test::sameBits(drawn.host, drawn.plugin));
}

} // namespace
} // namespace shutter
