// SPDX-License-Identifier: MIT
// The motion blur on raw handles: pictures by either interface equal the plugin's, bit for bit if
// the host gives motion at the method's instants; and frames in flight that change their size.
#include "engine/image/metrics.h"
#include "tests/gpu/gbuffer_host.h"

#include <array>
#include <optional>

namespace shutter {
namespace {

using motion_blur::HostDevice;
using motion_blur::InstantNoise;
using motion_blur::MotionBlurSettings;
using test::BlurStage;
using test::expectSame;
using test::gather;
using test::HostFrame;
using test::MotionDescriber;
using test::settingsOf;
using test::StagedFrame;

class EmbeddedPictures : public test::EmbeddedTest {
  protected:
    static void
    expectSameAsPlugin(const HostDevice& host, const char* method, bool hasTriangle, bool hasC) {
        SCOPED_TRACE(method);
        test::SceneBuilder scene;
        test::buildMovers(scene);
        BlurStage stage(device(), scene, host, settingsOf(method), settingsOf(method));
        if (hasTriangle)
            stage.giveTriangle();
        if (!hasC)
            stage.host.blurOfC = nullptr;
        const image::Image sharp = stage.drawSharp().color;
        stage.request.intermediates = {"mask"};
        const StagedFrame drawn = stage.draw();
        EXPECT_FALSE(test::sameBits(drawn.result.color, sharp)) << "nothing was blurred";
        expectSame(drawn);
        if (!hasC) {
            EXPECT_GT(test::countSet(drawn.result.intermediates.at("mask")), 50u);
        }
    }
};

TEST_F(EmbeddedPictures, EachMethodWithoutRaysGivesTheBitsOfThePlugin) {
    for (const motion_blur::Method* method : motion_blur::listMethods())
        if (method->readsImagesOnly())
            expectSameAsPlugin(describeHost(), method->name, true, true);
    expectSameAsPlugin(describeHost(), "gather", false, true);
}

TEST_F(EmbeddedPictures, HybridGivesTheBitsOfThePlugin) {
    if (!device().hasRays())
        GTEST_SKIP() << "the device traces no rays";
    HostDevice host = describeHost();
    host.rayTier = device().info().rayTier;
    expectSameAsPlugin(host, "hybrid", true, false);
}

/// rosado2007 of a host without Shutter's tables: it follows the given cameras.
TEST_F(EmbeddedPictures, TheCameraAloneIsFollowedAsByThePlugin) {
    for (const bool cameraMoves : {true, false}) {
        test::SceneBuilder scene;
        test::buildMovers(scene);
        if (cameraMoves)
            scene.moveCamera({.velocity = {0.4, 0.1, -0.3}, .angularVelocity = {0.02, 0.1, 0.05}});
        const MotionBlurSettings settings = settingsOf("rosado2007");
        BlurStage stage(device(), scene, describeHost(), settings, settings);
        stage.host.changeInputs = [&](const render::PostContext& context, auto& inputs) {
            inputs.rays = {};
            inputs.convention.cameras = test::declareCameras(scene.world, context.view);
            inputs.convention.scales.exposureShare = 1.0f;
        };
        const image::Image sharp = stage.drawSharp().color;
        const StagedFrame drawn = stage.draw();
        EXPECT_TRUE(test::sameBits(drawn.byC, drawn.output));
        EXPECT_TRUE(test::sameBits(drawn.inPlace, drawn.output));
        if (cameraMoves) {
            EXPECT_LT(image::computePsnr(drawn.result.color, sharp), 35.0) << "nothing was blurred";
            EXPECT_GT(image::computePsnr(drawn.output, drawn.result.color), 55.0);
        } else {
            EXPECT_TRUE(test::sameBits(drawn.output, sharp)) << "movers before a static camera";
        }
    }
}

// Validation finds whatever is destroyed or overwritten while a frame is in flight.
TEST_F(EmbeddedPictures, FramesInFlightMayChangeTheirSize) {
    std::array<gpu::Frame, 2> frames{gpu::Frame(device()), gpu::Frame(device())};
    gpu::LivingObjects small;
    gpu::LivingObjects last;
    for (uint32_t i = 0; i < 12; ++i) {
        const bool isLarge = i >= 4 && i < 8;
        const HostFrame host(device(), isLarge ? 120 : 40, isLarge ? 72 : 24);
        gpu::Frame& frame = frames[i % 2];
        frame.begin(); // waits for the one before the last
        host.recordClears(frame.commands());
        const core::Status done = mBlur->record(frame.commands(), i % 2, host.inputs(), gather());
        ASSERT_TRUE(done.ok()) << done.error().message;
        frame.submit();
        (i < 4 ? small : last) = mBlur->living();
    }
    for (gpu::Frame& frame : frames)
        frame.wait();
    EXPECT_GT(small.images, 0u);
    EXPECT_EQ(last, small) << "what the large pictures needed is gone";
}

TEST_F(EmbeddedPictures, ResourcesRetiredByAResizeAreFreedWhenTheirFramesAreDone) {
    HostDevice description = describeHost();
    description.framesInFlight = 3;
    mBlur = create(description);
    const auto draw = [&](uint32_t slot, uint32_t size) {
        const HostFrame host(device(), size, size);
        submit([&](VkCommandBuffer commands) {
            host.recordClears(commands);
            EXPECT_TRUE(mBlur->record(commands, slot, host.inputs(), gather()).ok());
        });
    };
    draw(0, 40);
    const gpu::LivingObjects one = mBlur->living();
    draw(1, 40); // not marked as done until below
    draw(0, 80);
    draw(0, 40);
    draw(0, 40);
    EXPECT_GT(mBlur->living().images, 2 * one.images) << "frame 1 may still use what was retired";
    EXPECT_TRUE(mBlur->markDone(1).ok());
    draw(0, 40);
    EXPECT_LE(mBlur->living().images, 2 * one.images);
}

constexpr uint32_t kPictureInstants = 7;

MotionBlurSettings resolved(InstantNoise noise = InstantNoise::Off) {
    MotionBlurSettings settings = settingsOf("resolved", kPictureInstants);
    settings.instantNoise = noise;
    return settings;
}

/// Movers that cross before a wall, one of which spins, under a camera that goes and turns.
class Scene : public test::SceneBuilder {
  public:
    Scene() {
        setPerspective(1.0);
        moveCamera({.velocity = {0.4, 0.1, -0.6}, .angularVelocity = {0.1, 0.5, 0.2}});
        const auto waves = addTextured(addWaveTexture(), true);
        guest = add(test::makeQuad(0.4, 0.4, waves), {.position = {1.0, 0.8, -5.0}});
        add(test::makeQuad(14.0, 9.0, waves), {.position = {0.0, 0.0, -6.0}});
        add(test::makeQuad(1.2, 1.2, waves),
            {.position = {0.2, 0.1, -3.0}, .velocity = {3.0, 0.6, 0.0}});
        add(test::makeBox(math::dvec3(0.8), waves),
            {.position = {-1.0, -0.4, -4.0}, .angularVelocity = {1.0, 2.0, 6.0}});
    }

    ecs::Entity guest;
};

/// `resolved`, frame after frame, for a host that gives the motion of its camera and entities.
class EmbeddedInstants : public test::EmbeddedTest {
  protected:
    void start(MotionDescriber describer, const MotionBlurSettings& settings = resolved()) {
        mDescriber.emplace(std::move(describer));
        mStage.emplace(device(), mScene, describeHost(), settings, settings);
        mStage->declareMotion(*mDescriber);
        mStage->shutter.exposureSeconds = mStage->frameSeconds = 0.25;
        mStage->shutter.phase = scene::ShutterPhase::End;
    }

    void TearDown() override {
        mStage.reset();
        EmbeddedTest::TearDown();
    }

    StagedFrame draw(int frame) {
        mStage->host.frameNumber = frame;
        mStage->seconds = frame * mStage->frameSeconds;
        return mStage->draw();
    }

    /// The plugin draws the raster of the frame before the first one. The host has none.
    void drawFirst() {
        (void)draw(0);
        mDescriber->followsLast = true;
    }

    static uint64_t countFromLast(const StagedFrame& drawn) {
        return drawn.result.statistics.counters.at("samples from the last frame");
    }

    Scene mScene;
    std::optional<MotionDescriber> mDescriber;
    std::optional<BlurStage> mStage;
};

TEST_F(EmbeddedInstants, KeysAtTheInstantsGiveTheBitsOfThePlugin) {
    for (const scene::ShutterPhase phase : {scene::ShutterPhase::End, scene::ShutterPhase::Centre})
        for (const bool isTriangle : {false, true}) {
            mStage.reset();
            mScene = Scene();
            start(MotionDescriber(kPictureInstants));
            mStage->shutter.phase = phase;
            if (isTriangle)
                mStage->giveTriangle();
            drawFirst();
            scene::despawn(mScene.world, mScene.guest); // and all rows move up
            for (const int frame : {1, 2}) {
                const StagedFrame next = draw(frame);
                EXPECT_GT(countFromLast(next), 0u);
                expectSame(next);
            }
        }
}

TEST_F(EmbeddedInstants, AFirstFrameWithoutHistoryHasTheBitsOfThePlugin) {
    MotionBlurSettings settings = resolved();
    settings.history = false;
    start(MotionDescriber(kPictureInstants), settings);
    mStage->host.blurOfC = nullptr; // it has no other settings than the samples
    const StagedFrame first = draw(0);
    EXPECT_EQ(countFromLast(first), 0u);
    expectSame(first);
}

TEST_F(EmbeddedInstants, NoiseHasTheBitsOfThePluginInEachFrame) {
    for (const InstantNoise noise : {InstantNoise::Fixed, InstantNoise::PerFrame}) {
        const MotionBlurSettings settings = resolved(noise);
        start(MotionDescriber(motion_blur::countInstants(settings)), settings);
        mStage->host.blurOfC = nullptr;
        drawFirst();
        for (const int frame : {1, 2})
            expectSame(draw(frame));
    }
}

TEST_F(EmbeddedInstants, ThreeKeysAreAsGoodAsOnesAtEachInstant) {
    start(MotionDescriber(0, {0.0, 0.5, 1.0}));
    drawFirst();
    const StagedFrame next = draw(1);
    EXPECT_GT(countFromLast(next), 0u);
    EXPECT_GT(image::computePsnr(next.output, next.result.color), 60.0);
    EXPECT_TRUE(test::sameBits(next.output, next.inPlace));
}

TEST_F(EmbeddedInstants, MoversWithoutTransformsFollowTheirMotionVectors) {
    start(MotionDescriber(0, {0.0, 0.5, 1.0}));
    mDescriber->knowsMovers = false;
    const StagedFrame drawn = draw(0);
    EXPECT_GT(image::computePsnr(drawn.output, drawn.result.color), 25.0);
    EXPECT_FALSE(test::sameBits(drawn.output, drawn.result.color));
}

} // namespace
} // namespace shutter
