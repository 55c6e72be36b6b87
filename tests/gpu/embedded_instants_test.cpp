// SPDX-License-Identifier: MIT
// `resolved` on raw handles: a host that says how its camera and entities move gets what the plugin
// gives, bit for bit where it says it at the instants themselves.
#include "engine/extract/frame_view.h"
#include "engine/image/metrics.h"
#include "engine/render/renderer.h"
#include "engine/scene/exposure_motion.h"
#include "engine/scene/history.h"
#include "modules/motion_blur/plugin/motion_blur_plugin.h"
#include "tests/gpu/gbuffer_host.h"
#include "tests/gpu/motion_teller.h"
#include "tests/kit/scene_builder.h"
#include "tests/support/picture.h"

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

namespace shutter {
namespace {

using math::dvec3;
using motion_blur::HostMotion;
using motion_blur::InstantNoise;
using motion_blur::MotionBlurSettings;
using test::HostOfTheGBuffer;
using test::Teller;

constexpr uint32_t kWidth = 96;
constexpr uint32_t kHeight = 64;
constexpr double kFrameSeconds = 0.25;
constexpr uint32_t kInstants = 7;

MotionBlurSettings resolved(InstantNoise noise = InstantNoise::Off) {
    MotionBlurSettings settings;
    settings.method = &motion_blur::getMethod("resolved");
    settings.sampleCount = kInstants;
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
        add(test::makeBox(dvec3(0.8), waves),
            {.position = {-1.0, -0.4, -4.0}, .angularVelocity = {1.0, 2.0, 6.0}});
    }

    ecs::Entity guest;
};

struct Drawn {
    image::Image plugin;
    image::Image output;
    image::Image inPlace;
    image::Image byC;
    uint64_t fromLast = 0; ///< samples that the plugin found in the last frame's raster
};

/// Draws frame after frame with the host's blur before the plugin's.
class Sequence {
  public:
    Sequence(
        gpu::Device& device,
        Scene& scene,
        motion_blur::EmbeddedMotionBlur& blur,
        Teller& teller,
        scene::ShutterPhase phase,
        const MotionBlurSettings& settings = resolved()
    )
        : mScene(scene), mRenderer(device, scene.world.assets),
          mHost(device, blur, settings, {kWidth, kHeight}),
          mPlugin(device, mRenderer.scene(), settings), mC(device) {
        mHost.blurOfC = mC.blur;
        mShutter.exposureSeconds = kFrameSeconds;
        mShutter.phase = phase;
        mHost.describeMotion = [this,
                                &teller](const render::PostContext& context, HostMotion& motion) {
            teller.tell(mScene.world, context, motion);
        };
    }

    Drawn draw(int frame) {
        mHost.frameNumber = frame;
        render::FrameRequest request;
        request.view.camera = mScene.camera;
        request.view.exposure =
            scene::computeExposure(mShutter, frame * kFrameSeconds, kFrameSeconds);
        request.view.width = kWidth;
        request.view.height = kHeight;
        const std::array<render::PostEffect*, 2> effects{&mHost, &mPlugin};
        auto drawn = mRenderer.renderFrame(mScene.world, request, effects);
        EXPECT_TRUE(drawn.ok());
        return {
            drawn.value().color,
            mHost.output.read(),
            mHost.inPlace.read(),
            mHost.byC.read(),
            drawn.value().statistics.counters.at("samples from the last frame")};
    }

    void giveTriangle() {
        mShutter.response.shape = scene::ResponseShape::Triangle;
        mHost.responseForC = test::triangleResponse();
    }

  private:
    Scene& mScene;
    scene::CameraShutter mShutter;
    render::Renderer mRenderer;
    HostOfTheGBuffer mHost;
    motion_blur::MotionBlurPlugin mPlugin;
    test::BlurOfC mC;
};

class EmbeddedInstants : public test::EmbeddedTest {
  protected:
    static void expectSame(const Drawn& drawn) {
        EXPECT_TRUE(test::sameBits(drawn.output, drawn.plugin));
        EXPECT_TRUE(test::sameBits(drawn.inPlace, drawn.plugin));
    }
};

TEST_F(EmbeddedInstants, KeysAtTheInstantsGiveTheBitsOfThePlugin) {
    for (const scene::ShutterPhase phase : {scene::ShutterPhase::End, scene::ShutterPhase::Centre})
        for (const bool isTriangle : {false, true}) {
            Scene scene;
            const auto blur = create(describeHost());
            ASSERT_TRUE(blur);
            Teller teller(kInstants);
            Sequence sequence(device(), scene, *blur, teller, phase);
            if (isTriangle)
                sequence.giveTriangle();
            // The plugin draws the raster of the frame before the first one. The host has none.
            (void)sequence.draw(0);
            teller.followsLast = true;
            scene::despawn(scene.world, scene.guest); // and all rows move up
            for (const int frame : {1, 2}) {
                const Drawn next = sequence.draw(frame);
                EXPECT_GT(next.fromLast, 0u);
                expectSame(next);
                EXPECT_TRUE(test::sameBits(next.byC, next.plugin));
            }
        }
}

TEST_F(EmbeddedInstants, WithoutHistoryAFirstFrameHasTheBitsOfThePlugin) {
    Scene scene;
    const auto blur = create(describeHost());
    ASSERT_TRUE(blur);
    MotionBlurSettings settings = resolved();
    settings.history = false;
    Teller teller(kInstants);
    Sequence sequence(device(), scene, *blur, teller, scene::ShutterPhase::End, settings);
    const Drawn first = sequence.draw(0);
    EXPECT_EQ(first.fromLast, 0u);
    expectSame(first);
}

TEST_F(EmbeddedInstants, NoiseHasTheBitsOfThePluginInEachFrame) {
    for (const InstantNoise noise : {InstantNoise::Fixed, InstantNoise::Turning}) {
        Scene scene;
        const auto blur = create(describeHost());
        ASSERT_TRUE(blur);
        const MotionBlurSettings settings = resolved(noise);
        Teller teller(motion_blur::countInstants(settings));
        Sequence sequence(device(), scene, *blur, teller, scene::ShutterPhase::End, settings);
        (void)sequence.draw(0);
        teller.followsLast = true;
        for (const int frame : {1, 2})
            expectSame(sequence.draw(frame));
    }
}

TEST_F(EmbeddedInstants, ThreeKeysAreAsGoodAsOnesAtEachInstant) {
    Scene scene;
    const auto blur = create(describeHost());
    ASSERT_TRUE(blur);
    Teller teller(0, {0.0, 0.5, 1.0});
    Sequence sequence(device(), scene, *blur, teller, scene::ShutterPhase::End);
    (void)sequence.draw(0);
    teller.followsLast = true;
    const Drawn next = sequence.draw(1);
    EXPECT_GT(next.fromLast, 0u);
    EXPECT_GT(image::computePsnr(next.output, next.plugin), 60.0);
    EXPECT_TRUE(test::sameBits(next.output, next.inPlace));
}

TEST_F(EmbeddedInstants, MoversWithoutTransformsFollowTheirMotionVectors) {
    Scene scene;
    const auto blur = create(describeHost());
    ASSERT_TRUE(blur);
    Teller teller(0, {0.0, 0.5, 1.0});
    teller.knowsMovers = false;
    Sequence sequence(device(), scene, *blur, teller, scene::ShutterPhase::End);
    const Drawn drawn = sequence.draw(0);
    EXPECT_GT(image::computePsnr(drawn.output, drawn.plugin), 25.0);
    EXPECT_FALSE(test::sameBits(drawn.output, drawn.plugin));
}

TEST_F(EmbeddedInstants, AnOrthographicCameraIsTheSame) {
    Scene scene;
    scene.cameraSettings().kind = scene::CameraKind::Orthographic;
    scene.cameraSettings().yMag = 2.0;
    const auto blur = create(describeHost());
    ASSERT_TRUE(blur);
    Teller teller(kInstants);
    Sequence sequence(device(), scene, *blur, teller, scene::ShutterPhase::End);
    (void)sequence.draw(0);
    teller.followsLast = true;
    expectSame(sequence.draw(1));
}

} // namespace
} // namespace shutter
