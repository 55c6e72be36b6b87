// SPDX-License-Identifier: MIT
// Preparation before a host's frames and reports after them: memory, pipelines, times and counters,
// the budget.
#include "engine/math/transform.h"
#include "tests/gpu/embedding_host.h"
#include "tests/kit/sweep.h"

#include <array>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace shutter {
namespace {

using motion_blur::EmbeddedMotionBlur;
using motion_blur::HostInputs;
using motion_blur::HostPlan;
using motion_blur::MotionBlurSettings;

/// Counts the library's calls of a driver function while it lives: functions are pointers.
template <auto pointer> class LibraryCalls;

template <class... Args, VkResult(VKAPI_PTR** pointer)(Args...)> class LibraryCalls<pointer> {
  public:
    LibraryCalls() {
        sNext = *pointer;
        sCount = 0;
        *pointer = [](Args... args) {
            ++sCount;
            return sNext(args...);
        };
    }

    ~LibraryCalls() { *pointer = sNext; }

    LibraryCalls(const LibraryCalls&) = delete;
    LibraryCalls& operator=(const LibraryCalls&) = delete;

    [[nodiscard]] uint32_t count() const { return sCount; }

  private:
    static inline VkResult(VKAPI_PTR* sNext)(Args...) = nullptr;
    static inline uint32_t sCount = 0;
};

/// A host's images for every method, and a frame in which all of the picture moves.
struct Host : test::HostFrame {
    Host(gpu::Device& device, uint32_t w, uint32_t h)
        : HostFrame(device, w, h),
          normal(test::makeImage(device, "normal", VK_FORMAT_R16G16B16A16_SFLOAT, w, h)),
          bytes(test::makeImage(device, "bytes", kBytes, w, h)),
          key{1.0, glm::dmat4(1.0), math::clipFromViewPerspective(1.0, double(w) / h, 0.1)} {}

    [[nodiscard]] HostInputs inputs() const {
        HostInputs in = HostFrame::inputs();
        in.entityId = ids();
        in.normal = {normal.handle(), test::kWritten, test::kSampled};
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
        if (plan.drawsBlended) {
            in.drawn.record = [](const motion_blur::BlendedTask&) {};
            in.drawn.area.extent = {plan.width, plan.height / 2};
        } else if (plan.blendedPixels > 0) {
            in.blended = in.normal;
            in.normal = {};
        }
        in.motion.lens.radius = plan.hasLens ? 0.05 : 0.0;
        if (plan.colorFormat == kBytes) {
            in.color = {bytes.handle(), test::kWritten, test::kSampled};
            in.color.format = kBytes;
            in.output = {};
            in.transfer.curve = shader::kTransferSrgb;
        }
        return in;
    }

    void recordClears(VkCommandBuffer commands) const {
        HostFrame::recordClears(commands);
        test::clear(commands, normal, {});
        test::clear(commands, bytes, {{0.5f, 0.25f, 0.0f, 1.0f}});
    }

    static constexpr VkFormat kBytes = VK_FORMAT_R8G8B8A8_UNORM;

    gpu::Image normal;
    gpu::Image bytes;
    motion_blur::HostCameraKey key;
    motion_blur::HostMover mover{0, {}};
};

/// What hosts need that differ in passes and memory.
struct Kind {
    const char* method;
    const char* with = ""; ///< what it has besides
    bool isStill = false;  ///< without ids, in a world in which nothing moves by itself
    bool draws = false;    ///< over the picture at instants
    bool blends = false;   ///< passes a drawing
    bool hasLens = false;  ///< which is closed in some frames
    bool isStored = false; ///< colours are bytes in gamma space, blurred in place
    motion_blur::InstantNoise noise = motion_blur::InstantNoise::Off; ///< then more instants
};

constexpr std::array<Kind, 11> kKinds{
    {{"gather"},
     {"hybrid"},
     {"resolved"},
     {"adaptive"},
     {.method = "resolved", .with = "no ids", .isStill = true},
     {.method = "resolved", .with = "draws", .draws = true},
     {.method = "gather", .with = "a layer", .blends = true},
     {.method = "resolved", .with = "a lens", .hasLens = true},
     {.method = "resolved",
      .with = "a lens and noise",
      .hasLens = true,
      .noise = motion_blur::InstantNoise::Fixed},
     {.method = "adaptive", .with = "a lens", .hasLens = true},
     {.method = "own_velocity", .with = "bytes", .isStored = true}}};

/// Each makes its pipelines anew, for seconds (`adaptive` for half a minute): the one with the
/// fewest passes, one with many that may have a lens or none, and one whose colours are prepared
/// and delivered; all of them with SHUTTER_ALL.
std::vector<Kind> listKinds() {
    if (test::drawsAll())
        return {kKinds.begin(), kKinds.end()};
    return {kKinds.front(), kKinds[8], kKinds.back()};
}

MotionBlurSettings aheadSettings(const char* method) {
    return test::settingsOf(method, 7);
}

HostPlan planOf(const Kind& kind, uint32_t width, uint32_t height) {
    HostPlan plan;
    plan.settings = aheadSettings(kind.method);
    plan.settings.instantNoise = kind.noise;
    plan.hasLens = kind.hasLens;
    if (kind.isStored) {
        plan.colorFormat = Host::kBytes;
        plan.outputFormat = VK_FORMAT_UNDEFINED;
    }
    if (kind.isStill)
        plan.entityIdFormat = VK_FORMAT_UNDEFINED;
    plan.width = width;
    plan.height = height;
    plan.drawsBlended = kind.draws;
    if (kind.draws || kind.blends)
        plan.blendedPixels = uint64_t{width} * height / (kind.draws ? 2 : 1);
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
        core::Status done;
        submit([&](VkCommandBuffer commands) {
            host.recordClears(commands);
            done = blur.record(commands, slot, in, settings);
        });
        return done;
    }

    [[nodiscard]] motion_blur::HostDevice hostOfSuite() const override {
        motion_blur::HostDevice described = describeHost();
        described.measures = true;
        return described;
    }
};

TEST_F(EmbeddedAhead, TheMemoryEstimateIsWithinATenthOfTheMemoryUsed) {
    for (const math::uvec2 size : {math::uvec2(64, 48), math::uvec2(200, 112)})
        for (const Kind& kind : listKinds()) {
            SCOPED_TRACE(std::string(kind.method) + " with " + kind.with);
            const HostPlan plan = planOf(kind, size.x, size.y);
            const auto reported = EmbeddedMotionBlur::estimateMemory(describeHost(), plan);
            ASSERT_TRUE(reported.ok()) << reported.error().message;
            const auto blur = create(describeHost());
            const Host host(device(), size.x, size.y);
            for (uint32_t frame = 0; frame < 6; ++frame) {
                HostInputs in = host.inputs(plan);
                if (frame >= 4) // a host may close its lens
                    in.motion.lens = {};
                const core::Status done = draw(*blur, host, frame % 2, in, plan.settings);
                ASSERT_TRUE(done.ok()) << done.error().message;
            }
            const auto held = double(blur->living().memoryBytes);
            EXPECT_NEAR(double(reported.value()), held, 0.1 * held);
        }
}

TEST_F(EmbeddedAhead, APlanThatCannotBeRecordedIsRefused) {
    const auto refuse = [](const HostPlan& plan, const std::string& part) {
        const auto reported = EmbeddedMotionBlur::estimateMemory(describeHost(), plan);
        test::expectRefusal(reported ? core::Status() : core::Status(reported.error()), part);
    };
    HostPlan plan = planOf({"resolved"}, 64, 0);
    refuse(plan, "the size is 64 x 0");
    plan = planOf({"resolved"}, 64, 64);
    plan.viewCount = 3;
    refuse(plan, "plan.viewCount is 3");
    plan = planOf({"gather"}, 64, 64);
    plan.hasLens = true;
    refuse(plan, "plan.hasLens is true, but the method gather has no lens");
    test::expectRefusal(create(describeHost())->warmUp(plan), "plan.hasLens is true");
    plan = planOf({"denoised"}, 64, 64);
    refuse(plan, "denoised");
}

TEST_F(EmbeddedAhead, RecordMakesNoPipelinesAfterAWarmUpAndLaterNoMemory) {
    for (const Kind& kind : listKinds())
        for (const bool isAsynchronous : {false, true}) {
            if (isAsynchronous && std::string(kind.method) != "gather" && !test::drawsAll())
                continue; // the thread does what the call would
            SCOPED_TRACE(std::string(kind.method) + (isAsynchronous ? " on a thread" : ""));
            const auto blur = create(describeHost());
            const Host host(device(), 96, 64);
            HostPlan plan = planOf(kind, 96, 64);
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
            const auto drawFrames = [&](uint32_t count) {
                for (uint32_t frame = 0; frame < count; ++frame)
                    EXPECT_TRUE(draw(*blur, host, frame % 2, host.inputs(plan), plan.settings).ok()
                    );
                if (!plan.hasLens)
                    return;
                HostInputs pinhole = host.inputs(plan); // a host may close it, too
                pinhole.motion.lens = {};
                EXPECT_TRUE(draw(*blur, host, 0, pinhole, plan.settings).ok());
            };
            const LibraryCalls<&vkCreateComputePipelines> pipelines;
            drawFrames(4);
            EXPECT_EQ(pipelines.count(), 0u);
            const LibraryCalls<&vkAllocateMemory> allocations;
            drawFrames(2);
            EXPECT_EQ(allocations.count(), 0u);
        }
}

/// Tables of many rows may overflow a tile's list, and have other pipelines than those of few.
TEST_F(EmbeddedAhead, AWarmUpForManyRowsHasThePipelinesOfFewAndOfMany) {
    for (const bool hasLens : {false, true}) {
        SCOPED_TRACE(hasLens ? "a lens" : "no lens");
        const auto blur = create(describeHost());
        const Host host(device(), 96, 64);
        HostPlan plan = planOf({.method = "resolved", .hasLens = hasLens}, 96, 64);
        plan.rowCount = 100;
        plan.settings.history = hasLens;
        const core::Status done = blur->warmUp(plan);
        ASSERT_TRUE(done.ok()) << done.error().message;
        const LibraryCalls<&vkCreateComputePipelines> pipelines;
        for (const uint32_t rows : {1u, plan.rowCount})
            for (const double way : {0.0, 0.5}) { // of the camera over the exposure
                std::array<motion_blur::HostCameraKey, 2> keys = {host.key, host.key};
                keys[0].time = 0.0;
                keys[0].viewFromWorld[3].x = way;
                HostInputs in = host.inputs(plan);
                in.motion.keys = keys;
                in.motion.movers = {};
                in.motion.rowCount = rows;
                for (uint32_t frame = 0; frame < 2; ++frame)
                    EXPECT_TRUE(draw(*blur, host, frame, in, plan.settings).ok());
            }
        EXPECT_EQ(pipelines.count(), 0u);
    }
}

TEST_F(EmbeddedAhead, AReportHasTimesOfEachPassAndCounters) {
    const Host host(device(), 96, 64);
    EmbeddedMotionBlur* const blur = mBlur.get();
    EXPECT_FALSE(create(hostOfSuite())->report(0).ok()) << "nothing was recorded";
    EXPECT_FALSE(blur->report(2).ok()) << "there is no such number";
    for (const char* method : {"hybrid", "resolved", "adaptive"}) {
        ASSERT_TRUE(draw(*blur, host, 1, host.inputs(), aheadSettings(method)).ok());
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
    ASSERT_TRUE(blur->record(pending.commands(), 0, host.inputs(), aheadSettings("gather")).ok());
    EXPECT_FALSE(blur->report(0).ok()) << "the GPU has not run it";
    pending.submit();
    pending.wait();
    EXPECT_TRUE(blur->report(0).ok());
    const auto silent = create(describeHost());
    ASSERT_TRUE(draw(*silent, host, 0, host.inputs(), aheadSettings("own_velocity")).ok());
    EXPECT_FALSE(silent->report(0).ok()) << "it does not measure";
}

TEST_F(EmbeddedAhead, ABudgetReducesQualityUntilItIsMet) {
    const Host host(device(), 96, 64);
    EmbeddedMotionBlur* const blur = mBlur.get();
    HostInputs in = host.inputs();
    for (const double radius : {0.0, 0.05}) { // the cheapest methods have no lens
        in.motion.lens.radius = radius;
        in.budget.milliseconds = radius == 0.0 ? 1e-6 : 2e-6; // nothing fits
        std::string droppedQuality;
        for (uint32_t frame = 0; frame < 8; ++frame) {
            ASSERT_TRUE(draw(*blur, host, frame % 2, in, aheadSettings("resolved")).ok());
            droppedQuality = blur->report(frame % 2).value().droppedQuality;
            if (frame == 0) {
                EXPECT_EQ(droppedQuality, "");
            }
        }
        EXPECT_NE(droppedQuality, "");
        EXPECT_NE(droppedQuality.find("all but"), std::string::npos) << droppedQuality;
    }
    in.budget.milliseconds = 1e6; // a new budget restarts
    ASSERT_TRUE(draw(*blur, host, 0, in, aheadSettings("resolved")).ok());
    EXPECT_EQ(blur->report(0).value().droppedQuality, "");
}

} // namespace
} // namespace shutter
