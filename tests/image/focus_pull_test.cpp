// SPDX-License-Identifier: MIT
// A film in which the focus is pulled, as a flight of the project draws it.
#include "assets/generator/demo_scenes.h"
#include "engine/image/metrics.h"
#include "engine/scene/auto_focus.h"
#include "engine/scene/lens.h"
#include "game/options/shot_arguments.h"
#include "game/shot/picture_drawer.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/picture.h"
#include "tests/support/temp_folder.h"

#include <optional>
#include <string>
#include <vector>

namespace shutter {
namespace {

class FocusPull : public test::GpuTest {
  protected:
    void SetUp() override {
        GpuTest::SetUp();
        if (IsSkipped() || HasFatalFailure())
            return;
        const test::TempFolder folder;
        game::ShotArguments arguments;
        arguments.scene = (folder.path() / "gallery.glb").string();
        ASSERT_EQ(generator::buildGalleryScene().write(arguments.scene), "");
        arguments.flythrough =
            std::string(SHUTTER_SOURCE_DIR) + "/assets/flythroughs/gallery_focus.json";
        arguments.size = {160, 90};
        mOptions = game::interpret(arguments).value();
        mOptions.usesLens = true;
        const core::Status loaded = game::loadFlythrough(arguments, mOptions);
        ASSERT_TRUE(loaded.ok()) << loaded.error().message;
        mShot.emplace(game::loadShot(mOptions).value());
        mRenderer.emplace(device(), mShot->world.assets);
        mDrawer.emplace(device(), *mRenderer);
    }

    void TearDown() override {
        mDrawer.reset();
        mRenderer.reset();
        GpuTest::TearDown();
    }

    /// \param isSmooth over the whole pixel
    image::Image
    draw(game::PictureDrawer& drawer, std::string_view method, size_t frame, bool isSmooth = true) {
        game::MethodOptions options = game::makeMethod(*game::findMethod(method).value());
        if (method == "accumulate")
            options.samples = 256;
        game::ShotOptions shot = mOptions;
        if (method == "accumulate")
            shot.pixel = extract::PixelModel::Box;
        else if (isSmooth)
            shot.picture.antiAliasing = game::AntiAliasing::Box;
        const game::PictureRequest picture =
            game::makePicture(*mShot, shot, options, mOptions.frameTimes.at(frame));
        auto drawn = drawer.draw(mShot->world, picture);
        EXPECT_TRUE(drawn.ok());
        return std::move(drawn).value().color;
    }

    game::ShotOptions mOptions;
    std::optional<game::Shot> mShot;
    std::optional<render::Renderer> mRenderer;
    std::optional<game::PictureDrawer> mDrawer;
};

TEST_F(FocusPull, EveryFrameByResolvedIsNearTheMeanOfManyPictures) {
    // In focus is the near target, what lies between, the wall; then the lens is stopped down.
    double nearest = 1e9;
    double farthest = 0.0;
    for (size_t frame = 6; frame < mOptions.frameTimes.size(); frame += 11) {
        const double focus =
            scene::lensAt(mShot->world, mShot->camera, mOptions.frameTimes[frame]).focusDistance;
        nearest = std::min(nearest, focus);
        farthest = std::max(farthest, focus);
        const image::Image mean = draw(*mDrawer, "accumulate", frame);
        const double resolved = image::computePsnr(draw(*mDrawer, "resolved", frame), mean);
        const double sharp = image::computePsnr(draw(*mDrawer, "sharp", frame), mean);
        RecordProperty(
            std::to_string(frame), std::to_string(resolved) + ", " + std::to_string(sharp)
        );
        EXPECT_GE(resolved, 37.0) << frame;
        EXPECT_GE(resolved, sharp + 10.0) << frame;
    }
    EXPECT_LT(nearest, 1.5);
    EXPECT_GT(farthest, 6.0);
}

TEST_F(FocusPull, AFrameIsTheSameWhicheverWereDrawnBefore) {
    std::vector<image::Image> inOrder;
    for (size_t frame = 24; frame < 28; ++frame)
        inOrder.push_back(draw(*mDrawer, "resolved", frame, false));
    for (const size_t frame : {27, 25}) {
        game::PictureDrawer alone(device(), *mRenderer);
        EXPECT_TRUE(test::sameBits(draw(alone, "resolved", frame, false), inOrder[frame - 24]))
            << frame;
    }
}

} // namespace
} // namespace shutter
