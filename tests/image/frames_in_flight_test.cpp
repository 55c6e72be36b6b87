// SPDX-License-Identifier: MIT
// Frames that the CPU submits before the GPU is done with those before: the same pictures.
#include "engine/scene/history.h"
#include "modules/motion_blur/plugin/motion_blur_plugin.h"
#include "tests/kit/scene_builder.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/picture.h"

#include <array>
#include <vector>

namespace shutter {
namespace {

using math::dvec3;
using test::SceneBuilder;

constexpr int kFrames = 9;

/// Movers, one of them comes and goes, before a wall, under a camera that moves.
struct Scene {
    SceneBuilder builder;
    ecs::Entity guest;

    Scene() {
        builder.setPerspective(0.9);
        builder.moveCamera({.velocity = {0.1, 0, 0}});
        const auto waves = builder.addTextured(builder.addWaveTexture());
        builder.add(test::makeQuad(9, 7, waves), {.position = {0, 0, -6}});
        builder.add(
            test::makeQuad(0.7, 0.7, builder.addColor({1, 0, 0})),
            {.position = {-0.6, 0, -2}, .velocity = {0.8, 0.1, 0}}
        );
        guest = builder.add(
            test::makeQuad(0.5, 0.4, builder.addColor({0, 0, 1})),
            {.position = {0.5, 0.3, -3}, .velocity = {-0.7, 0.2, 0}}
        );
    }

    void prepare(int frame) {
        if (frame == 3)
            scene::hide(builder.world, guest);
        if (frame == 6)
            scene::show(builder.world, guest, 0.05 * frame);
    }
};

struct Sequence {
    std::vector<image::Image> colors;
    std::vector<render::Counters> counters;
};

Sequence draw(gpu::Device& device, uint32_t framesInFlight) {
    Scene scene;
    render::Renderer renderer(device, scene.builder.world.assets, framesInFlight);
    motion_blur::MotionBlurPlugin blur(
        device, renderer.scene(), {.method = &motion_blur::getMethod("hybrid")}
    );
    std::array<render::PostEffect*, 1> effects{&blur};
    Sequence sequence;
    const auto finish = [&] {
        render::FrameResult result = renderer.finishFrame();
        sequence.colors.push_back(std::move(result.color));
        // How many rows were written depends on what each frame in flight held before.
        result.statistics.counters.erase("entity rows written");
        result.statistics.counters.erase("entity motions written");
        sequence.counters.push_back(result.statistics.counters);
    };
    for (int i = 0; i < kFrames; ++i) {
        scene.prepare(i);
        if (renderer.unfinishedCount() == framesInFlight)
            finish();
        render::FrameRequest request;
        request.view.camera = scene.builder.camera;
        request.view.exposure =
            scene::computeExposure({0.25, scene::ShutterPhase::Centre}, 0.05 * i);
        // The picture changes its size on the way.
        request.view.width = i < 5 ? 96 : 80;
        request.view.height = 64;
        EXPECT_TRUE(renderer.submitFrame(scene.builder.world, request, effects).ok());
    }
    while (renderer.unfinishedCount() > 0)
        finish();
    return sequence;
}

class FramesInFlight : public test::GpuTest {};

TEST_F(FramesInFlight, GiveThePicturesAndCountersOfFramesOneByOne) {
    if (!device().hasRays())
        GTEST_SKIP() << device().info().name << " traces no rays";
    const Sequence alone = draw(device(), 1);
    ASSERT_EQ(alone.colors.size(), size_t{kFrames});
    EXPECT_GT(alone.counters[2].at("pixels masked"), 100u);
    EXPECT_NE(alone.counters[2], alone.counters[4]);
    for (const uint32_t count : {2u, gpu::kMaxFramesInFlight}) {
        const Sequence ahead = draw(device(), count);
        ASSERT_EQ(ahead.colors.size(), alone.colors.size());
        for (size_t i = 0; i < alone.colors.size(); ++i) {
            EXPECT_TRUE(test::sameBits(ahead.colors[i], alone.colors[i])) << count << ", " << i;
            EXPECT_EQ(ahead.counters[i], alone.counters[i]) << count << ", " << i;
        }
    }
}

} // namespace
} // namespace shutter
