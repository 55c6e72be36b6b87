// SPDX-License-Identifier: MIT
// Pictures on the way of a progressive method, as a benchmark takes them.
#include "game/shot/picture_drawer.h"
#include "tests/kit/scene_builder.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/picture.h"

#include <map>

namespace shutter {
namespace {

class Checkpoints : public test::GpuTest {
  protected:
    void SetUp() override {
        GpuTest::SetUp();
        if (!IsSkipped() && !HasFatalFailure() && !device().hasRayQuery())
            GTEST_SKIP() << device().info().name << " has no ray queries";
    }
};

game::Shot makeShot() {
    test::SceneBuilder scene;
    scene.setPerspective(0.9);
    scene.add(
        test::makeBox({0.8, 0.8, 0.8}, scene.addColor({0.9f, 0.2f, 0.1f})),
        {.position = {0, 0, -3}, .velocity = {0.8, 0, 0}}
    );
    scene.world.registry.add(scene.camera, scene::CameraShutter{1.0, scene::ShutterPhase::Centre});
    game::Shot shot;
    shot.world = std::move(scene.world);
    shot.camera = scene.camera;
    return shot;
}

game::PictureRequest makePicture(const game::Shot& shot, uint32_t rays) {
    game::ShotOptions options;
    options.width = 40;
    options.height = 30;
    game::MethodOptions method = game::makeMethod(*game::findMethod("truth").value());
    method.samples = rays;
    return game::makePicture(shot, options, method, 0.0);
}

TEST_F(Checkpoints, EachIsThePictureOfThatManyRays) {
    const game::Shot shot = makeShot();
    render::Renderer renderer(device(), shot.world.assets);
    const auto draw = [&](uint32_t rays, const game::Checkpoints& checkpoints, uint32_t& steps) {
        const game::PictureRequest picture = makePicture(shot, rays);
        steps = 0;
        auto result = game::PictureDrawer(device(), renderer)
                          .draw(
                              shot.world, picture, [&] { ++steps; }, checkpoints
                          );
        EXPECT_TRUE(result.ok());
        EXPECT_EQ(steps, game::PictureDrawer::countSteps(picture.method));
        return std::move(result).value();
    };
    uint32_t steps = 0;
    std::map<uint32_t, render::FrameResult> found;
    game::Checkpoints checkpoints;
    checkpoints.rays = {8, 1, 4, 2, 100};
    checkpoints.onPicture = [&](uint32_t rays, const render::FrameResult& picture) {
        found[rays] = picture;
    };
    const auto whole = draw(8, checkpoints, steps);
    ASSERT_EQ(found.size(), 4u);
    for (const auto& [rays, picture] : found) {
        EXPECT_TRUE(test::sameBits(picture.color, draw(rays, {}, steps).color)) << rays;
        EXPECT_EQ(picture.statistics.counters.at("rays a pixel"), rays);
        EXPECT_EQ(picture.statistics.counters.at("rays traced"), uint64_t(rays) * 40 * 30);
    }
    EXPECT_LT(found.at(1).statistics.wallMilliseconds, found.at(8).statistics.wallMilliseconds)
        << "times are summed";
    EXPECT_TRUE(test::sameBits(whole.color, found.at(8).color));
}

TEST_F(Checkpoints, AnEarlyStopShowsTheMeanOfTheRaysThatWereTraced) {
    const game::Shot shot = makeShot();
    render::Renderer renderer(device(), shot.world.assets);
    game::PictureDrawer drawer(device(), renderer);
    game::PictureRequest picture = makePicture(shot, 64);
    picture.method.error = 1.0;
    uint32_t steps = 0;
    const auto count = [&] { ++steps; };
    game::Checkpoints checkpoints{{16, 32}, [](uint32_t, const render::FrameResult&) {}};
    const auto stopped = drawer.draw(shot.world, picture, count, checkpoints);
    ASSERT_TRUE(stopped.ok());
    EXPECT_EQ(steps, 64u) << "the bar is full";
    EXPECT_EQ(stopped.value().statistics.counters.at("rays a pixel"), 16u);
    const auto expected = drawer.draw(shot.world, makePicture(shot, 16), count);
    EXPECT_TRUE(test::sameBits(stopped.value().color, expected.value().color));
    EXPECT_GT(stopped.value().statistics.measures.at("standard error"), 0.0);
}

} // namespace
} // namespace shutter
