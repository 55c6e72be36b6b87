// SPDX-License-Identifier: MIT
// Passes that a frame can do without: each waits for those before it, whatever little it does.
#include "game/shot/picture_drawer.h"
#include "tests/kit/scene_builder.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/picture.h"

#include <algorithm>
#include <string>

namespace shutter {
namespace {

struct Drawer {
    test::SceneBuilder scene;
    render::Renderer renderer;
    game::PictureDrawer pictures;

    explicit Drawer(gpu::Device& device)
        : scene(makeScene()), renderer(device, scene.world.assets), pictures(device, renderer) {}

    static test::SceneBuilder makeScene() {
        test::SceneBuilder builder;
        builder.setPerspective(0.9);
        const auto waves = builder.addTextured(builder.addWaveTexture());
        builder.add(test::makeQuad(9, 7, waves), {.position = {0, 0, -6}});
        builder.add(
            test::makeQuad(0.7, 0.7, builder.addColor({1, 0, 0})),
            {.position = {-0.2, 0, -2}, .velocity = {0.8, 0.1, 0}}
        );
        return builder;
    }

    render::FrameResult draw(const char* method, bool wantCounters) {
        game::PictureRequest request;
        request.frame.view.camera = scene.camera;
        request.frame.view.exposure =
            scene::computeExposure({0.25, scene::ShutterPhase::Centre}, 0.0);
        request.frame.view.width = 96;
        request.frame.view.height = 64;
        request.frame.wantCounters = wantCounters;
        request.method = game::makeMethod(*game::findMethod(method).value());
        auto drawn = pictures.draw(scene.world, request);
        EXPECT_TRUE(drawn) << (drawn ? "" : drawn.error().message);
        return drawn ? std::move(drawn).value() : render::FrameResult();
    }
};

ptrdiff_t countPasses(const render::FrameResult& frame, const std::string& start) {
    const auto& passes = frame.statistics.passes;
    return std::count_if(passes.begin(), passes.end(), [&](const render::PassTime& pass) {
        return pass.name.starts_with(start);
    });
}

class PassCount : public test::GpuTest {};

TEST_F(PassCount, AllThatAMethodMustFindEmptyIsClearedInOnePass) {
    Drawer drawer(device());
    for (const char* method : {"gather", "hybrid", "resolved", "adaptive"}) {
        if (!game::canRun(*game::findMethod(method).value(), device()))
            continue;
        const render::FrameResult frame = drawer.draw(method, true);
        EXPECT_EQ(countPasses(frame, "clear"), 1) << method;
    }
}

TEST_F(PassCount, WhatNobodyReadsIsNotReadBack) {
    Drawer drawer(device());
    const auto check = [&](const char* method, const char* counter, const char* pass) {
        if (!game::canRun(*game::findMethod(method).value(), device()))
            return;
        // Frames that follow are alike: the first builds what rays need and counts its blocks.
        (void)drawer.draw(method, true);
        const render::FrameResult counted = drawer.draw(method, true);
        const render::FrameResult plain = drawer.draw(method, false);
        EXPECT_TRUE(counted.statistics.counters.contains(counter)) << method;
        EXPECT_FALSE(plain.statistics.counters.contains(counter)) << method;
        EXPECT_EQ(countPasses(counted, pass), 1) << method;
        EXPECT_EQ(countPasses(plain, pass), 0) << method;
        EXPECT_EQ(plain.statistics.passes.size() + 1, counted.statistics.passes.size()) << method;
        EXPECT_TRUE(test::sameBits(plain.color, counted.color)) << method;
        // They choose how the next frame's still pixels are copied.
        EXPECT_TRUE(plain.statistics.counters.contains("blocks still")) << method;
    };
    check("hybrid", "pixels masked", "read ray mask counters");
    check("resolved", "unresolved samples", "read resolved counters");
}

} // namespace
} // namespace shutter
