// SPDX-License-Identifier: MIT
// What a host learns and prepares before its frames, and what it is told after them: memory,
// pipelines, times and counters, the budget, presets.
#include "engine/gpu/frame.h"
#include "engine/gpu/vulkan.h"
#include "engine/math/transform.h"
#include "modules/motion_blur/c_interface/shutter_motion_blur.h"
#include "modules/motion_blur/presets.h"
#include "tests/gpu/embedding_host.h"
#include "tests/support/picture.h"

#include <cstring>
#include <memory>
#include <string>
#include <thread>
#include <vector>

namespace shutter {
namespace {

using motion_blur::EmbeddedMotionBlur;
using motion_blur::getMethod;
using motion_blur::HostInputs;
using motion_blur::HostPlan;
using motion_blur::MotionBlurSettings;
using test::kNothing;
using test::kSampled;
using test::kWritten;

/// Counts what the library asks the driver for: its functions are pointers.
struct Asked {
    Asked() {
        sAsked = this;
        mPipelines = vkCreateComputePipelines;
        mAllocate = vkAllocateMemory;
        vkCreateComputePipelines = countPipelines;
        vkAllocateMemory = countAllocations;
    }

    ~Asked() {
        vkCreateComputePipelines = mPipelines;
        vkAllocateMemory = mAllocate;
    }

    Asked(const Asked&) = delete;
    Asked& operator=(const Asked&) = delete;

    uint32_t pipelines = 0;
    uint32_t allocations = 0;

  private:
    static VkResult VKAPI_CALL countPipelines(
        VkDevice device,
        VkPipelineCache cache,
        uint32_t count,
        const VkComputePipelineCreateInfo* infos,
        const VkAllocationCallbacks* callbacks,
        VkPipeline* pipelines
    ) {
        sAsked->pipelines += count;
        return sAsked->mPipelines(device, cache, count, infos, callbacks, pipelines);
    }

    static VkResult VKAPI_CALL countAllocations(
        VkDevice device,
        const VkMemoryAllocateInfo* info,
        const VkAllocationCallbacks* callbacks,
        VkDeviceMemory* memory
    ) {
        ++sAsked->allocations;
        return sAsked->mAllocate(device, info, callbacks, memory);
    }

    static inline Asked* sAsked = nullptr;
    PFN_vkCreateComputePipelines mPipelines;
    PFN_vkAllocateMemory mAllocate;
};

/// A host's images for every method, and a frame in which all of the picture moves.
struct Host : test::HostFrame {
    Host(gpu::Device& device, uint32_t w, uint32_t h)
        : HostFrame(device, w, h), ids(test::makeImage(device, "ids", VK_FORMAT_R32_UINT, w, h)),
          normal(test::makeImage(device, "normal", VK_FORMAT_R16G16B16A16_SFLOAT, w, h)),
          key{1.0, glm::dmat4(1.0), math::clipFromViewPerspective(1.0, double(w) / h, 0.1)} {}

    [[nodiscard]] HostInputs inputs() const {
        HostInputs in = HostFrame::inputs();
        in.entityId = {ids.handle(), kWritten, kSampled};
        in.normal = {normal.handle(), kWritten, kSampled};
        in.motion.keys = {&key, 1};
        in.motion.movers = {&mover, 1};
        in.motion.rowCount = 1;
        in.motion.followsLast = true;
        in.reveal.record = [](const motion_blur::RevealTask&) {};
        in.samples.record = [](const motion_blur::SampleTask&) {};
        return in;
    }

    /// Those that the plan is of.
    [[nodiscard]] HostInputs inputs(const HostPlan& plan) const {
        HostInputs in = inputs();
        if (plan.entityIdFormat == VK_FORMAT_UNDEFINED) {
            in.entityId = {};
            in.motion.movers = {};
        }
        return in;
    }

    void recordClears(VkCommandBuffer commands) const {
        HostFrame::recordClears(commands);
        const VkImageSubresourceRange all{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
        const VkClearColorValue none{};
        for (const gpu::Image* image : {&ids, &normal}) {
            test::moveOn(commands, image->handle(), kNothing, kWritten);
            vkCmdClearColorImage(commands, image->handle(), kWritten.layout, &none, 1, &all);
        }
    }

    gpu::Image ids;
    gpu::Image normal;
    motion_blur::HostCameraKey key;
    motion_blur::HostMover mover{0, {}};
};

MotionBlurSettings settingsOf(const char* method) {
    MotionBlurSettings settings;
    settings.method = &getMethod(method);
    settings.sampleCount = 7;
    return settings;
}

/// Of a host without ids, in whose world nothing moves by itself.
constexpr const char* kStillWorld = "resolved without ids";

HostPlan planOf(const char* method, uint32_t width, uint32_t height) {
    HostPlan plan;
    const bool isStill = method == kStillWorld;
    plan.settings = settingsOf(isStill ? "resolved" : method);
    if (isStill)
        plan.entityIdFormat = VK_FORMAT_UNDEFINED;
    plan.width = width;
    plan.height = height;
    return plan;
}

class EmbeddedAhead : public test::EmbeddedTest {
  protected:
    static core::Status draw(
        EmbeddedMotionBlur& blur,
        const Host& host,
        uint32_t slot,
        const HostInputs& in,
        const MotionBlurSettings& settings
    ) {
        gpu::Frame frame(device());
        frame.begin();
        host.recordClears(frame.commands());
        core::Status done = blur.record(frame.commands(), slot, in, settings);
        frame.submit();
        frame.wait();
        return done;
    }

    static std::unique_ptr<EmbeddedMotionBlur> createMeasuring() {
        motion_blur::HostDevice described = describeHost();
        described.measures = true;
        return create(described);
    }
};

TEST_F(EmbeddedAhead, MemoryIsToldWithinATenthOfWhatIsHeld) {
    for (const math::uvec2 size : {math::uvec2(64, 48), math::uvec2(200, 112)})
        for (const char* method : {"gather", "hybrid", "resolved", "adaptive", kStillWorld}) {
            SCOPED_TRACE(std::string(method) + " " + std::to_string(size.x));
            const HostPlan plan = planOf(method, size.x, size.y);
            const auto told = EmbeddedMotionBlur::estimateMemory(describeHost(), plan);
            ASSERT_TRUE(told.ok()) << told.error().message;
            const auto blur = create(describeHost());
            const Host host(device(), size.x, size.y);
            for (uint32_t frame = 0; frame < 4; ++frame) {
                const core::Status done =
                    draw(*blur, host, frame % 2, host.inputs(plan), plan.settings);
                ASSERT_TRUE(done.ok()) << done.error().message;
            }
            const auto held = double(blur->living().memoryBytes);
            EXPECT_NEAR(double(told.value()), held, 0.1 * held);
        }
}

TEST_F(EmbeddedAhead, APlanThatCannotBeRecordedIsRefused) {
    const auto refuse = [](const HostPlan& plan, const std::string& part) {
        const auto told = EmbeddedMotionBlur::estimateMemory(describeHost(), plan);
        ASSERT_FALSE(told.ok());
        EXPECT_NE(told.error().message.find(part), std::string::npos) << told.error().message;
    };
    HostPlan plan = planOf("resolved", 64, 0);
    refuse(plan, "the size is 64 x 0");
    plan = planOf("resolved", 64, 64);
    plan.viewCount = 3;
    refuse(plan, "plan.viewCount is 3");
    plan = planOf("denoised", 64, 64);
    refuse(plan, "denoised");
}

TEST_F(EmbeddedAhead, RecordMakesNoPipelinesAfterAWarmUpAndLaterNoMemory) {
    for (const char* method : {"gather", "hybrid", "resolved", "adaptive", kStillWorld})
        for (const bool isAsynchronous : {false, true}) {
            SCOPED_TRACE(std::string(method) + (isAsynchronous ? " on a thread" : ""));
            const auto blur = create(describeHost());
            const Host host(device(), 96, 64);
            HostPlan plan = planOf(method, 96, 64);
            if (isAsynchronous) {
                ASSERT_TRUE(blur->startWarmUp(plan).ok());
                EXPECT_FALSE(blur->startWarmUp(plan).ok()) << "one at a time";
                core::Result<bool> isWarm = blur->isWarm();
                for (; isWarm.ok() && !isWarm.value(); isWarm = blur->isWarm())
                    std::this_thread::yield();
                ASSERT_TRUE(isWarm.ok()) << isWarm.error().message;
            } else {
                const core::Status done = blur->warmUp(plan);
                ASSERT_TRUE(done.ok()) << done.error().message;
            }
            Asked asked;
            for (uint32_t frame = 0; frame < 4; ++frame)
                ASSERT_TRUE(draw(*blur, host, frame % 2, host.inputs(plan), plan.settings).ok());
            EXPECT_EQ(asked.pipelines, 0u);
            asked.allocations = 0;
            for (uint32_t frame = 0; frame < 2; ++frame)
                ASSERT_TRUE(draw(*blur, host, frame % 2, host.inputs(plan), plan.settings).ok());
            EXPECT_EQ(asked.allocations, 0u);
        }
}

TEST_F(EmbeddedAhead, AReportHasTimesOfEachPassAndCounters) {
    const auto blur = createMeasuring();
    const Host host(device(), 96, 64);
    EXPECT_FALSE(blur->report(0).ok()) << "nothing was recorded";
    EXPECT_FALSE(blur->report(2).ok()) << "there is no such number";
    for (const char* method : {"hybrid", "resolved", "adaptive"}) {
        ASSERT_TRUE(draw(*blur, host, 1, host.inputs(), settingsOf(method)).ok());
        const auto report = blur->report(1);
        ASSERT_TRUE(report.ok()) << report.error().message;
        EXPECT_GT(report.value().passes.size(), 4u);
        double sum = 0.0;
        for (const gpu::PassTime& pass : report.value().passes)
            sum += pass.gpuMilliseconds;
        EXPECT_GT(sum, 0.0);
        EXPECT_DOUBLE_EQ(report.value().milliseconds, sum);
        EXPECT_TRUE(report.value().counters.contains("blocks mixed"));
        EXPECT_EQ(
            report.value().counters.contains("pixels masked"), std::string(method) == "hybrid"
        );
        EXPECT_EQ(
            report.value().counters.contains("unresolved samples"), std::string(method) != "hybrid"
        );
    }
    gpu::Frame pending(device());
    pending.begin();
    host.recordClears(pending.commands());
    ASSERT_TRUE(blur->record(pending.commands(), 0, host.inputs(), settingsOf("gather")).ok());
    EXPECT_FALSE(blur->report(0).ok()) << "the GPU has not run it";
    pending.submit();
    pending.wait();
    EXPECT_TRUE(blur->report(0).ok());
    const auto silent = create(describeHost());
    ASSERT_TRUE(draw(*silent, host, 0, host.inputs(), settingsOf("gather")).ok());
    EXPECT_FALSE(silent->report(0).ok()) << "it does not measure";
}

TEST_F(EmbeddedAhead, ABudgetGivesUpQualityUntilItIsKept) {
    const auto blur = createMeasuring();
    const Host host(device(), 96, 64);
    HostInputs in = host.inputs();
    in.budget.milliseconds = 1e-6; // nothing fits
    std::string gaveUp;
    for (uint32_t frame = 0; frame < 8; ++frame) {
        ASSERT_TRUE(draw(*blur, host, frame % 2, in, settingsOf("resolved")).ok());
        gaveUp = blur->report(frame % 2).value().gaveUp;
        if (frame == 0) {
            EXPECT_EQ(gaveUp, "");
        }
    }
    EXPECT_NE(gaveUp, "");
    in.budget.milliseconds = 1e6; // a new budget begins anew
    ASSERT_TRUE(draw(*blur, host, 0, in, settingsOf("resolved")).ok());
    EXPECT_EQ(blur->report(0).value().gaveUp, "");
}

TEST_F(EmbeddedAhead, EachPresetRunsInCAndOffIsACopy) {
    ShutterBlurDevice described = shutterBlurDefaultDevice();
    described.physical = device().physical();
    described.device = device().handle();
    described.queueFamily = device().queueFamily();
    described.measures = VK_TRUE;
    ShutterBlur* blur = nullptr;
    ASSERT_EQ(shutterBlurCreate(&described, &blur), SHUTTER_BLUR_SUCCESS);
    const Host host(device(), 96, 64);
    for (const motion_blur::Preset& preset : motion_blur::listPresets()) {
        SCOPED_TRACE(preset.name);
        const test::Picture output(device(), "output", {96, 64});
        gpu::Frame frame(device());
        frame.begin();
        host.recordClears(frame.commands());
        ShutterBlurInputs in = shutterBlurDefaultInputs();
        in.width = 96;
        in.height = 64;
        const auto give =
            [](VkImage image, const graph::OutsideUse& before, const graph::OutsideUse& after) {
                ShutterBlurImage made{};
                made.image = image;
                made.before = {before.layout, before.stages, before.access};
                made.after = {after.layout, after.stages, after.access};
                return made;
            };
        in.color = give(host.color.handle(), kWritten, kSampled);
        in.motionDepth = give(host.motionDepth.handle(), kWritten, kSampled);
        in.entityId = give(host.ids.handle(), kWritten, kSampled);
        in.normal = give(host.normal.handle(), kWritten, kSampled);
        in.output = give(output.handle(), kNothing, test::kCopied);
        ShutterBlurCameraKey key{1.0, {}, {}};
        std::memcpy(key.viewFromWorld, &host.key.viewFromWorld, sizeof(key.viewFromWorld));
        std::memcpy(key.clipFromView, &host.key.clipFromView, sizeof(key.clipFromView));
        const ShutterBlurMover mover{0, nullptr};
        in.keys = &key;
        in.movers = &mover;
        in.keyCount = in.moverCount = in.rowCount = 1;
        in.recordReveal = [](void*, const ShutterBlurRevealTask*) {};
        in.recordSamples = [](void*, const ShutterBlurSampleTask*) {};
        ShutterBlurSettings settings = shutterBlurDefaultSettings();
        settings.preset = preset.name;
        EXPECT_EQ(
            shutterBlurRecord(blur, frame.commands(), 0, &in, &settings), SHUTTER_BLUR_SUCCESS
        ) << shutterBlurGetMessage();
        output.recordReadback(frame.commands());
        frame.submit();
        frame.wait();
        ShutterBlurReport report = shutterBlurDefaultReport();
        ASSERT_EQ(shutterBlurGetReport(blur, 0, &report), SHUTTER_BLUR_SUCCESS)
            << shutterBlurGetMessage();
        EXPECT_GT(report.passCount, 0u);
        EXPECT_EQ(report.counterCount == 0, preset.isOff);
        if (!preset.isOff)
            continue;
        const image::Image picture = output.read();
        for (size_t i = 0; i < picture.pixels.size(); i += 4)
            ASSERT_EQ(picture.pixels[i], 3.0f) << "the input, to the bit";
    }
    ShutterBlurPlan plan = shutterBlurDefaultPlan();
    plan.width = 96;
    plan.height = 64;
    uint64_t bytes = 0;
    EXPECT_EQ(shutterBlurEstimateMemory(&described, &plan, &bytes), SHUTTER_BLUR_SUCCESS)
        << shutterBlurGetMessage();
    EXPECT_GT(bytes, 0u);
    EXPECT_EQ(shutterBlurWarmUp(blur, &plan), SHUTTER_BLUR_SUCCESS) << shutterBlurGetMessage();
    EXPECT_EQ(shutterBlurStartWarmUp(blur, &plan), SHUTTER_BLUR_SUCCESS);
    VkBool32 isWarm = VK_FALSE;
    while (!isWarm && shutterBlurIsWarm(blur, &isWarm) == SHUTTER_BLUR_SUCCESS)
        std::this_thread::yield();
    EXPECT_TRUE(isWarm);
    EXPECT_EQ(shutterBlurEstimateMemory(&described, &plan, nullptr), SHUTTER_BLUR_ERROR_REFUSED);
    shutterBlurDestroy(blur);
}

} // namespace
} // namespace shutter
