// SPDX-License-Identifier: MIT
// Pictures that share a view share the measurement of its cap; a method that looks at the frame
// before gets it, whether a sequence drew it or not.
#include "game/shot/picture_drawer.h"
#include "modules/bloom/bloom.h"
#include "modules/tonemap/tonemap.h"
#include "tests/kit/scene_builder.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/picture.h"

#include <algorithm>
#include <array>
#include <optional>
#include <set>
#include <string>
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

    /// What is drawn from now on.
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

TEST_F(PictureDrawerTest, AFrameOfASequenceIsTheFrameDrawnAlone) {
    useShutter({.exposureSeconds = 1.0 / 30.0});
    game::PictureDrawer inSequence(device(), *mRenderer);
    image::Image last;
    for (const int frame : {0, 1, 2})
        last = draw(inSequence, "resolved", frame * mOptions.frameSeconds);
    game::PictureDrawer alone(device(), *mRenderer);
    EXPECT_TRUE(test::sameBits(draw(alone, "resolved", 2 * mOptions.frameSeconds), last));
    // Drawn again, after it: the frame before is not what was drawn last.
    EXPECT_TRUE(test::sameBits(draw(alone, "resolved", 2 * mOptions.frameSeconds), last));
    // Another method in between leaves nothing that could be taken for a frame before.
    EXPECT_FALSE(test::sameBits(draw(inSequence, "gather", 3 * mOptions.frameSeconds), last));
    EXPECT_TRUE(test::sameBits(
        draw(inSequence, "resolved", 4 * mOptions.frameSeconds),
        draw(alone, "resolved", 4 * mOptions.frameSeconds)
    ));
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
    const auto runsBloom = [&](double seconds, bool isAsked) {
        game::PictureRequest picture = game::makePicture(
            mShot, mOptions, game::makeMethod(*game::findMethod("sharp").value()), seconds
        );
        picture.frame.wantDisplay = true;
        picture.frame.wantBrightest = isAsked;
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
    // Pictures that stand for themselves do not depend on those before.
    EXPECT_TRUE(runsBloom(0.0, false));
    EXPECT_TRUE(runsBloom(0.0, false));
    EXPECT_TRUE(runsBloom(0.0, true)) << "the last picture was not measured";
}

TEST_F(PictureDrawerTest, TheFrameBeforeIsDrawnForWhatIsLookedUpInItAlone) {
    useShutter({.exposureSeconds = 1.0 / 60.0});
    for (const char* method : {"resolved", "adaptive"}) {
        if (method == std::string("adaptive") && !device().hasRayQuery())
            continue;
        game::PictureRequest picture = game::makePicture(
            mShot, mOptions, game::makeMethod(*game::findMethod(method).value()), 0.5
        );
        picture.method.motionBlur.secondRaster = true;
        picture.frame.wantTrace = true;
        game::PictureDrawer drawer(device(), *mRenderer);
        const auto drawn = drawer.draw(mShot.world, picture);
        ASSERT_TRUE(drawn.ok());
        std::array<std::set<std::string>, 2> passes;
        for (const render::WrittenImage& image : drawn.value().trace)
            passes.at(image.frame).insert(image.pass);
        const auto& [before, own] = passes;
        EXPECT_TRUE(own.contains("second G-buffer") && own.contains("resolve")) << method;
        std::set<std::string> kept = before;
        kept.erase("keep colour"); // listed where the kept images can be read
        kept.erase("pack surface");
        EXPECT_EQ(kept, std::set<std::string>{"G-buffer"}) << method;
    }
}

} // namespace
} // namespace shutter
