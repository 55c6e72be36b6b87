// SPDX-License-Identifier: MIT
// The motion blur on raw handles: pictures by either interface equal the plugin's, bit for bit if
// the host gives motion at the method's instants, or hands in the engine's own layer of blended
// surfaces; and frames in flight that change their size.
#include "engine/image/metrics.h"
#include "modules/glass/blended_layer.h"
#include "modules/glass/blended_layer_pass.h"
#include "tests/gpu/gbuffer_host.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <optional>
#include <utility>
#include <vector>

namespace shutter {
namespace {

using math::vec4;
using motion_blur::HostDevice;
using motion_blur::HostInputs;
using motion_blur::InstantNoise;
using motion_blur::MotionBlurSettings;
using test::BlurStage;
using test::expectSame;
using test::gather;
using test::HostFrame;
using test::HostTexels;
using test::MotionDescriber;
using test::settingsOf;
using test::StagedFrame;

class EmbeddedPictures : public test::StagedTest {
  protected:
    void SetUp() override {
        StagedTest::SetUp();
        test::buildMovers(mScene);
    }

    static void expectSameAsPlugin(BlurStage& stage) {
        const image::Image sharp = stage.drawSharp().color;
        stage.request.intermediates = {"mask"};
        const StagedFrame drawn = stage.draw();
        EXPECT_FALSE(test::sameBits(drawn.result.color, sharp)) << "nothing was blurred";
        expectSame(drawn);
        if (!stage.host.blurOfC) {
            EXPECT_GT(test::countSet(drawn.result.intermediates.at("mask")), 50u);
        }
    }

    test::SceneBuilder mScene;
};

TEST_F(EmbeddedPictures, EachMethodWithoutRaysGivesTheBitsOfThePlugin) {
    const auto expectSameBy = [&](const char* method, bool hasTriangle) {
        SCOPED_TRACE(method);
        BlurStage stage(
            device(), mScene, *mBlur, blurOfC(), settingsOf(method), settingsOf(method)
        );
        if (hasTriangle)
            stage.giveTriangle();
        expectSameAsPlugin(stage);
    };
    for (const motion_blur::Method* method : motion_blur::listMethods())
        if (method->readsImagesOnly())
            expectSameBy(method->name, true);
    expectSameBy("gather", false);
}

TEST_F(EmbeddedPictures, HybridGivesTheBitsOfThePlugin) {
    if (!device().hasRays())
        GTEST_SKIP() << "the device traces no rays";
    HostDevice host = describeHost();
    host.rayTier = device().info().rayTier;
    BlurStage stage(device(), mScene, host, settingsOf("hybrid"));
    stage.giveTriangle();
    expectSameAsPlugin(stage);
}

/// rosado2007 of a host without Shutter's tables: it follows the given cameras.
TEST_F(EmbeddedPictures, TheCameraAloneIsFollowedAsByThePlugin) {
    for (const bool cameraMoves : {false, true}) {
        test::SceneBuilder& scene = mScene;
        if (cameraMoves)
            scene.moveCamera({.velocity = {0.4, 0.1, -0.3}, .angularVelocity = {0.02, 0.1, 0.05}});
        const MotionBlurSettings settings = settingsOf("rosado2007");
        BlurStage stage(device(), scene, *mBlur, blurOfC(), settings, settings);
        stage.host.changeInputs = [&](const render::PictureContext& context, auto& inputs) {
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
/// Barriers of memory and fills as they are recorded.
struct Recorded {
    VkPipelineStageFlags2 from = 0;
    VkPipelineStageFlags2 to = 0;
    VkDeviceSize filled = 0; ///< bytes; 0: a barrier
};

std::vector<Recorded> gRecorded;
PFN_vkCmdPipelineBarrier2 gBarrier = nullptr;
PFN_vkCmdFillBuffer gFill = nullptr;

VKAPI_ATTR void VKAPI_CALL noteBarrier(VkCommandBuffer commands, const VkDependencyInfo* info) {
    for (uint32_t i = 0; i < info->memoryBarrierCount; ++i)
        gRecorded.push_back(
            {info->pMemoryBarriers[i].srcStageMask, info->pMemoryBarriers[i].dstStageMask}
        );
    gBarrier(commands, info);
}

VKAPI_ATTR void VKAPI_CALL noteFill(
    VkCommandBuffer commands, VkBuffer buffer, VkDeviceSize at, VkDeviceSize bytes, uint32_t value
) {
    gRecorded.push_back({.filled = bytes});
    gFill(commands, buffer, at, bytes, value);
}

TEST_F(EmbeddedPictures, AFrameIsMarkedAsDoneBehindAllOfItsCommands) {
    const HostFrame given(device(), 64, 48);
    gRecorded.clear();
    submit([&](VkCommandBuffer commands) {
        given.recordClears(commands);
        gBarrier = std::exchange(vkCmdPipelineBarrier2, noteBarrier);
        gFill = std::exchange(vkCmdFillBuffer, noteFill);
        EXPECT_TRUE(mBlur->record(commands, 0, given.inputs(), gather()).ok());
        vkCmdPipelineBarrier2 = gBarrier;
        vkCmdFillBuffer = gFill;
    });
    const auto mark = std::find_if(gRecorded.rbegin(), gRecorded.rend(), [](const Recorded& one) {
        return one.filled == sizeof(uint32_t);
    });
    ASSERT_NE(mark, gRecorded.rend());
    const auto before = std::next(mark);
    ASSERT_NE(before, gRecorded.rend());
    EXPECT_EQ(before->from, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT);
    EXPECT_NE(before->to & VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, 0u);
}

TEST_F(EmbeddedPictures, FramesInFlightMayChangeTheirSize) {
    useOwn(describeHost()); // which holds nothing yet
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
    useOwn(description);
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
class EmbeddedInstants : public test::StagedTest {
  protected:
    void start(MotionDescriber describer, const MotionBlurSettings& settings = resolved()) {
        mDescriber.emplace(std::move(describer));
        mStage.emplace(device(), mScene, *mBlur, blurOfC(), settings, settings);
        mStage->declareMotion(*mDescriber);
        mStage->shutter.exposureSeconds = mStage->frameSeconds = 0.25;
        mStage->shutter.phase = scene::ShutterPhase::End;
    }

    void TearDown() override {
        mStage.reset();
        StagedTest::TearDown();
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

/// Panes before a wall and a mover, the layer of which a host hands in as its own.
class EmbeddedLayer : public test::StagedTest {
  protected:
    static scene::AssetIndex addGlass(test::SceneBuilder& scene, const math::vec3& color) {
        scene::Material material;
        material.baseColorFactor = vec4(color, 0.5f);
        material.alphaMode = scene::AlphaMode::Blend;
        material.unlit = true;
        material.doubleSided = true;
        return scene.addMaterial(std::move(material));
    }

    static void addPanes(test::SceneBuilder& scene) {
        scene.setPerspective(1.0);
        scene.add(
            test::makeQuad(12.0, 8.0, scene.addTextured(scene.addWaveTexture(), true)),
            {.position = {0, 0, -6}}
        );
        scene.add(
            test::makeQuad(1.4, 1.2, addGlass(scene, {0.2f, 0.5f, 0.9f})),
            {.position = {0, 0, -3}, .velocity = {1.6, 0.4, 0}}
        );
        scene.add(
            test::makeQuad(1.0, 1.6, addGlass(scene, {0.9f, 0.3f, 0.1f})),
            {.position = {0.5, 0, -2.5}, .velocity = {-1.2, 0, 0}}
        );
    }

    /// Draws once to learn the layer, and once more with it as the host's.
    void expectEnginesPicture(test::SceneBuilder& scene, const MotionBlurSettings& settings) {
        SCOPED_TRACE(settings.method->name);
        BlurStage stage(device(), scene, *mBlur, blurOfC(), settings, settings);
        MotionDescriber describer(settings.sampleCount);
        if (settings.method->readsInstantMotions)
            stage.declareMotion(describer);
        glass::BlendedLayerPass pass(device(), stage.renderer.scene());
        glass::BlendedLayer layer;
        stage.host.changeInputs = [&](const render::PictureContext& context, HostInputs&) {
            layer = plan(scene, stage, settings, context);
            ASSERT_FALSE(layer.empty());
            ASSERT_FALSE(layer.readsInstants) << "the host has one part";
            const render::OverlayPart drawn = pass.declare(overlayContextOf(context), layer, {}, 0);
            context.intermediates.publish("layer color", drawn.color);
            context.intermediates.publish("layer opacity", drawn.opacity);
        };
        stage.request.intermediates = {"layer color", "layer opacity"};
        const StagedFrame without = stage.draw();
        if (HasFatalFailure())
            return;
        EXPECT_FALSE(test::sameBits(without.output, without.result.color)) << "no layer was drawn";
        const HostTexels& texels = makeLayer(
            layer,
            without.result.intermediates.at("layer color"),
            without.result.intermediates.at("layer opacity")
        );
        submit([&](VkCommandBuffer commands) { texels.record(commands); });
        stage.host.changeInputs = [&](const render::PictureContext&, HostInputs& inputs) {
            inputs.blended = texels.describe();
            inputs.blended.after = inputs.blended.before; // three recordings read it
        };
        stage.request.intermediates = {};
        expectSame(stage.draw());
    }

    static render::OverlayContext overlayContextOf(const render::PictureContext& context) {
        return {
            .graph = context.graph,
            .view = context.view,
            .frame = context.frame,
            .shapes = context.shapes,
            .motionDepth = context.gbuffer.motionDepth,
            .shading = context.shading,
            .frameConstants = context.frameConstants,
            .slot = context.slot};
    }

    static glass::BlendedLayer plan(
        const test::SceneBuilder& scene,
        const test::BlurStage& stage,
        const MotionBlurSettings& settings,
        const render::PictureContext& context
    ) {
        const scene::ExposureMotion motion(scene.world, context.view.camera, context.view.exposure);
        render::OverlayLimits limits;
        if (settings.method->sampleUnit == motion_blur::SampleUnit::Instants)
            limits.instants = settings.sampleCount;
        limits.findsInstants = settings.method->readsInstantMotions;
        limits.surfaceBytes = device().limits().maxStorageBufferRange;
        return glass::planBlendedLayer(
            scene.world,
            stage.renderer.scene().layout(),
            context.view,
            motion,
            context.frame,
            context.takenRows,
            limits
        );
    }

    /// The picture's size, opacity in alpha.
    const HostTexels& makeLayer(
        const glass::BlendedLayer& layer, const image::Image& color, const image::Image& opacity
    ) {
        std::vector<uint64_t> texels(size_t{test::kStageSize.x} * test::kStageSize.y, 0);
        for (uint32_t y = 0; y < layer.sizePx.y; ++y)
            for (uint32_t x = 0; x < layer.sizePx.x; ++x) {
                const size_t from = size_t{y} * color.width + x; // it is larger than the layer
                const float* const rgb = &color.pixels[from * color.channels];
                const size_t to =
                    size_t{y + layer.originPx.y} * test::kStageSize.x + x + layer.originPx.x;
                texels[to] =
                    test::packHalf({rgb[0], rgb[1], rgb[2], opacity.pixels[from * opacity.channels]}
                    );
            }
        return makeTexels(
            VK_FORMAT_R16G16B16A16_SFLOAT, {test::kStageSize.x, test::kStageSize.y}, texels
        );
    }
};

TEST_F(EmbeddedLayer, GivenAsAnImageIsTheEnginesPictureByEachMethod) {
    for (const motion_blur::Method* method : motion_blur::listMethods()) {
        if (!method->readsImagesOnly())
            continue;
        test::SceneBuilder scene;
        addPanes(scene);
        expectEnginesPicture(scene, settingsOf(method->name));
    }
    // Nothing moves behind the panes, so that they have one part here, too.
    test::SceneBuilder scene;
    addPanes(scene);
    MotionBlurSettings resolved = settingsOf("resolved", 7);
    resolved.history = false;
    expectEnginesPicture(scene, resolved);
}

} // namespace
} // namespace shutter
