// SPDX-License-Identifier: MIT
// Pictures that share a view share the measurement of its cap; a method that uses the previous
// frame gets it, whether a sequence drew it or not; and intermediate pictures of a progressive
// method.
#include "game/shot/picture_drawer.h"
#include "modules/bloom/bloom.h"
#include "modules/tonemap/tonemap.h"
#include "tests/kit/scene_builder.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/picture.h"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

namespace shutter {
namespace {

class PictureDrawerTest : public test::GpuTest {
  protected:
    PictureDrawerTest() {
        mScene.setPerspective(0.9);
        mScene.add(
            test::makeBox({0.8, 0.8, 0.8}, mScene.addWaves()),
            {.position = {0, 0, -3}, .velocity = {0.8, 0, 0}}
        );
        mScene.add(test::makeQuad(6, 4, mScene.addWaves()), {.position = {0, 0, -5}});
        mOptions.width = 40;
        mOptions.height = 30;
    }

    /// The shutter of later pictures.
    void useShutter(const scene::CameraShutter& shutter) {
        mScene.world.registry.add(mScene.camera, shutter);
        mShot.world = std::move(mScene.world);
        mShot.camera = mScene.camera;
        mRenderer.emplace(device(), mShot.world.assets);
    }

    image::Image draw(
        game::PictureDrawer& drawer,
        const char* method,
        double seconds = 0.0,
        std::optional<scene::MotionCap> cap = {}
    ) {
        game::PictureRequest picture = game::makePicture(
            mShot, mOptions, game::makeMethod(*game::findMethod(method).value()), seconds
        );
        picture.cap = std::move(cap);
        auto drawn = drawer.draw(mShot.world, picture);
        EXPECT_TRUE(drawn.ok());
        return drawn ? std::move(drawn.value().color) : image::Image();
    }

    test::SceneBuilder mScene;
    game::Shot mShot;
    game::ShotOptions mOptions;
    std::optional<render::Renderer> mRenderer;
};

TEST_F(PictureDrawerTest, ACapThatIsGivenIsNotMeasuredAgain) {
    useShutter(
        {.exposureSeconds = 1.0, .phase = scene::ShutterPhase::Centre, .maxBlurPercent = 90.0}
    );
    game::PictureDrawer drawer(device(), *mRenderer);
    const image::Image sharp = draw(drawer, "sharp");
    EXPECT_FALSE(test::sameBits(draw(drawer, "gather"), sharp)) << "the measured cap leaves motion";
    const scene::MotionCap none{.camera = 0.0, .movers = {}};
    EXPECT_TRUE(test::sameBits(draw(drawer, "gather", 0.0, none), sharp));
}

TEST_F(PictureDrawerTest, AFrameInWhichSomethingJumpsIsTheFrameDrawnAloneAndLeavesTheSame) {
    const ecs::Entity stepping = mScene.add(
        test::makeBox({0.5, 0.5, 0.5}, mScene.addWaves()), {.position = {-0.8, 0.4, -3.5}}
    );
    scene::AnimationClip clip;
    clip.duration = 1.0;
    clip.channels.push_back(
        {0,
         scene::AnimationPath::Translation,
         scene::Interpolation::Step,
         {0.0f, 1.0f},
         {math::vec4(-0.8f, 0.4f, -3.5f, 0.0f), math::vec4(0.6f, -0.3f, -3.5f, 0.0f)}}
    );
    mScene.world.assets.clips.push_back(std::move(clip));
    mScene.world.registry.add(stepping, scene::Animated{{{0, 0}}});
    useShutter({.exposureSeconds = 1.0 / 30.0});
    // It steps in frame 2: within its exposure, or at its very end.
    for (const double steps : {2.0 - 0.3, 2.0})
        for (const game::AntiAliasing antiAliasing :
             {game::AntiAliasing::None, game::AntiAliasing::Box}) {
            mShot.world.assets.clips[0].channels[0].times[1] =
                static_cast<float>(steps * mOptions.frameSeconds);
            mOptions.picture.antiAliasing = antiAliasing;
            game::PictureDrawer inSequence(device(), *mRenderer);
            for (int frame = 0; frame < 5; ++frame) {
                const double seconds = frame * mOptions.frameSeconds;
                const image::Image drawn = draw(inSequence, "resolved", seconds);
                game::PictureDrawer alone(device(), *mRenderer);
                EXPECT_TRUE(test::sameBits(draw(alone, "resolved", seconds), drawn))
                    << "step at " << steps << ", frame " << frame << ", anti-aliasing "
                    << int(antiAliasing);
            }
        }
}

TEST_F(PictureDrawerTest, BloomFollowsTheHighlightsOfTheLastPictureThatIsFinished) {
    // A bright box comes into the picture between 0.5 s and 1 s, and never leaves it.
    mScene.add(
        test::makeBox({0.5, 0.5, 0.5}, mScene.addColor(math::vec3(4.0f))),
        {.position = {-6, 0, -3}, .velocity = {5, 0, 0}}
    );
    useShutter({.exposureSeconds = 0.0});
    bloom::Bloom bloom(device(), {.share = 0.2f, .threshold = 2.0f});
    tonemap::Tonemap tonemap(device(), {});
    game::PictureDrawer drawer(device(), *mRenderer);
    const auto runsBloom = [&](double seconds, bool isRequested) {
        game::PictureRequest picture = game::makePicture(
            mShot, mOptions, game::makeMethod(*game::findMethod("sharp").value()), seconds
        );
        picture.frame.wantDisplay = true;
        picture.frame.wantBrightest = isRequested;
        picture.ending = {&bloom, &tonemap};
        auto drawn = drawer.draw(mShot.world, picture);
        EXPECT_TRUE(drawn.ok());
        const auto& passes = drawn.value().statistics.passes;
        return std::any_of(passes.begin(), passes.end(), [](const render::PassTime& pass) {
            return pass.name.starts_with("bloom");
        });
    };
    EXPECT_TRUE(runsBloom(0.0, true)) << "nothing is known yet";
    EXPECT_FALSE(runsBloom(0.0, true));
    EXPECT_FALSE(runsBloom(1.0, true)) << "the last picture had no highlight";
    EXPECT_TRUE(runsBloom(1.0, true));
    EXPECT_TRUE(runsBloom(0.0, true)) << "the last picture had one";
    EXPECT_FALSE(runsBloom(0.0, true));
    // Independent pictures do not depend on earlier ones.
    EXPECT_TRUE(runsBloom(0.0, false));
    EXPECT_TRUE(runsBloom(0.0, false));
    EXPECT_TRUE(runsBloom(0.0, true)) << "the last picture was not measured";
}

/// Pictures on the way of a progressive method, as a benchmark takes them.
class Checkpoints : public PictureDrawerTest {
  protected:
    void SetUp() override {
        PictureDrawerTest::SetUp();
        if (IsSkipped() || HasFatalFailure())
            return;
        if (!device().hasRayQuery())
            GTEST_SKIP() << device().info().name << " has no ray queries";
        useShutter({.exposureSeconds = 1.0, .phase = scene::ShutterPhase::Centre});
    }

    [[nodiscard]] game::PictureRequest makeRays(uint32_t rays) const {
        game::MethodOptions method = game::makeMethod(*game::findMethod("truth").value());
        method.samples = rays;
        return game::makePicture(mShot, mOptions, method, 0.0);
    }
};

TEST_F(Checkpoints, EachIsThePictureOfThatManyRays) {
    const auto draw = [&](uint32_t rays, const game::Checkpoints& checkpoints, uint32_t& steps) {
        const game::PictureRequest picture = makeRays(rays);
        steps = 0;
        auto result = game::PictureDrawer(device(), *mRenderer)
                          .draw(
                              mShot.world, picture, [&] { ++steps; }, checkpoints
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
        EXPECT_EQ(picture.statistics.counters.at("rays per pixel"), rays);
        EXPECT_EQ(picture.statistics.counters.at("rays traced"), uint64_t(rays) * 40 * 30);
    }
    EXPECT_LT(found.at(1).statistics.wallMilliseconds, found.at(8).statistics.wallMilliseconds)
        << "times are summed";
    EXPECT_TRUE(test::sameBits(whole.color, found.at(8).color));
}

TEST_F(Checkpoints, AnEarlyStopShowsTheMeanOfTheRaysThatWereTraced) {
    game::PictureDrawer drawer(device(), *mRenderer);
    game::PictureRequest picture = makeRays(64);
    picture.method.error = 1.0;
    uint32_t steps = 0;
    const auto count = [&] { ++steps; };
    game::Checkpoints checkpoints{{16, 32}, [](uint32_t, const render::FrameResult&) {}};
    const auto stopped = drawer.draw(mShot.world, picture, count, checkpoints);
    ASSERT_TRUE(stopped.ok());
    EXPECT_EQ(steps, 64u) << "the bar is full";
    EXPECT_EQ(stopped.value().statistics.counters.at("rays per pixel"), 16u);
    const auto expected = drawer.draw(mShot.world, makeRays(16), count);
    EXPECT_TRUE(test::sameBits(stopped.value().color, expected.value().color));
    EXPECT_GT(stopped.value().statistics.measures.at("standard error"), 0.0);
}

} // namespace
} // namespace shutter
