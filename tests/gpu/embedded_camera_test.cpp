// SPDX-License-Identifier: MIT
// A host without Shutter's tables blurs by its camera alone: rosado2007 follows what it says of its
// cameras, as the plugin follows the engine's.
#include "engine/image/metrics.h"
#include "engine/render/renderer.h"
#include "engine/scene/exposure_motion.h"
#include "modules/motion_blur/plugin/motion_blur_plugin.h"
#include "tests/gpu/checked_shot.h"
#include "tests/gpu/gbuffer_host.h"
#include "tests/kit/scene_builder.h"
#include "tests/support/picture.h"

#include <array>

namespace shutter {
namespace {

using math::dvec3;
using motion_blur::getMethod;
using motion_blur::HostInputs;

constexpr uint32_t kWidth = 96;
constexpr uint32_t kHeight = 64;

class EmbeddedCamera : public test::EmbeddedTest {
  protected:
    struct Drawn {
        image::Image sharp;
        image::Image plugin;
        image::Image cpp;
        image::Image inPlace;
        image::Image c;
    };

    static Drawn draw(const test::Placement& camera) {
        test::SceneBuilder scene;
        scene.setPerspective(1.0);
        scene.moveCamera(camera);
        const auto waves = scene.addTextured(scene.addWaveTexture());
        scene.add(test::makeQuad(5.0, 3.0, waves), {.position = dvec3(0.0, 0.0, -5.0)});
        scene.add(
            test::makeBox(dvec3(0.8), waves),
            {.position = dvec3(0.2, 0.0, -2.5), .velocity = dvec3(1.0, 0.2, 0.0)}
        );
        render::Renderer renderer(device(), scene.world.assets);
        const auto blur = create(describeHost());
        const test::BlurOfC c(device());
        motion_blur::MotionBlurSettings settings;
        settings.method = &getMethod("rosado2007");
        test::HostOfTheGBuffer host(device(), *blur, settings, {kWidth, kHeight});
        host.blurOfC = c.blur;
        host.changeInputs = [&scene](const render::PostContext& context, HostInputs& inputs) {
            inputs.rays = {};
            inputs.convention.cameras = test::tellCameras(scene.world, context.view);
            inputs.convention.scales.exposureShare = 1.0f;
        };
        motion_blur::MotionBlurPlugin plugin(device(), renderer.scene(), settings);
        render::FrameRequest request;
        request.view.camera = scene.camera;
        scene::CameraShutter shutter;
        shutter.exposureSeconds = 0.5;
        request.view.exposure = scene::computeExposure(shutter, 0.0, scene::kStillFrameSeconds);
        request.view.width = kWidth;
        request.view.height = kHeight;
        const auto sharp = renderer.renderFrame(scene.world, request, {});
        const std::array<render::PostEffect*, 2> effects{&host, &plugin};
        const auto drawn = renderer.renderFrame(scene.world, request, effects);
        EXPECT_TRUE(sharp.ok() && drawn.ok());
        return {
            sharp.value().color,
            drawn.value().color,
            host.output.read(),
            host.inPlace.read(),
            host.byC.read()};
    }
};

TEST_F(EmbeddedCamera, GivesThePicturesOfThePluginByBothInterfaces) {
    const Drawn drawn = draw({.velocity = {0.4, 0.1, -0.3}, .angularVelocity = {0.02, 0.1, 0.05}});
    EXPECT_LT(image::computePsnr(drawn.plugin, drawn.sharp), 35.0) << "nothing was blurred";
    EXPECT_GT(image::computePsnr(drawn.cpp, drawn.plugin), 55.0);
    EXPECT_TRUE(test::sameBits(drawn.c, drawn.cpp));
    EXPECT_TRUE(test::sameBits(drawn.inPlace, drawn.cpp));
}

TEST_F(EmbeddedCamera, LeavesWhatMovesBeforeAStillCameraSharp) {
    const Drawn drawn = draw({});
    EXPECT_TRUE(test::sameBits(drawn.cpp, drawn.sharp));
}

} // namespace
} // namespace shutter
