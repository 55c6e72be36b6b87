// SPDX-License-Identifier: MIT
#include "engine/scene/camera.h"
#include "engine/scene/motion.h"
#include "game/bench/sequence/sequence_source.h"
#include "tests/support/temp_folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>

namespace shutter::bench {
namespace {

using test::TempFolder;

constexpr uint32_t kFrames = 6;

class SequenceSources : public testing::TestWithParam<const char*> {
  protected:
    void SetUp() override {
        std::filesystem::create_directories(mFolder.path() / "scenes");
        for (SequenceCase& film : makeSequenceSuite().sequences)
            if (film.name == GetParam())
                mFilm = film;
        ASSERT_EQ(mFilm.name, GetParam());
        auto files = writeSequenceFiles(mFilm, mFolder.path());
        ASSERT_TRUE(files.ok()) << files.error().message;
        mFiles = files.value();
    }

    [[nodiscard]] std::unique_ptr<SequenceSource> open() const {
        auto source = SequenceSource::open(mFilm, mFiles, kFrames);
        EXPECT_TRUE(source.ok()) << source.error().message;
        return std::move(source).value();
    }

    /// Where the camera of the view is at the view's own time.
    [[nodiscard]] static math::dmat4 placeOf(const SequenceSource& source) {
        const extract::ViewRequest view = source.view();
        return scene::worldFromEntity(source.world(), view.camera, view.exposure.raster);
    }

    [[nodiscard]] static double differenceOf(const math::dmat4& a, const math::dmat4& b) {
        double largest = 0.0;
        for (int column = 0; column < 4; ++column)
            for (int row = 0; row < 4; ++row)
                largest = std::max(largest, std::abs(a[column][row] - b[column][row]));
        return largest;
    }

    SequenceCase mFilm;
    SequenceFiles mFiles;

  private:
    TempFolder mFolder;
};

TEST_P(SequenceSources, GoFrameByFrameAndTheSameWayTwice) {
    const auto source = open();
    const auto again = open();
    double last = -1.0;
    for (uint32_t i = 0; i < kFrames; ++i) {
        source->advance();
        again->advance();
        const double seconds = source->view().exposure.raster;
        if (i > 0) {
            EXPECT_NEAR(seconds - last, source->framesPerSecond().secondsOf(1.0), 1e-9);
        }
        last = seconds;
        EXPECT_EQ(again->view().exposure.raster, seconds);
        EXPECT_EQ(differenceOf(placeOf(*again), placeOf(*source)), 0.0);
    }
    const scene::ExposureInterval exposure = source->view().exposure;
    EXPECT_GT(exposure.close - exposure.open, 0.0) << "a sharp film has nothing to judge";
}

TEST_P(SequenceSources, AStandingCameraStaysWhereTheirOwnWas) {
    const auto scout = open();
    for (uint32_t i = 0; i < kFrames; ++i)
        scout->advance();
    const StandingView there = scout->standingView();
    const auto source = open();
    source->stand(there);
    for (uint32_t i = 0; i < kFrames; ++i) {
        source->advance();
        EXPECT_LT(differenceOf(placeOf(*source), math::removeScale(placeOf(*scout))), 1e-9);
        const extract::ViewRequest view = source->view();
        EXPECT_FALSE(scene::mayMove(source->world(), view.camera));
        EXPECT_EQ(
            scene::yFovAt(source->world(), view.camera, view.exposure.raster), there.lens.yFov
        );
        EXPECT_NE(source->world().registry.find<scene::CameraShutter>(view.camera), nullptr);
    }
}

INSTANTIATE_TEST_SUITE_P(
    FlightsAndDemos,
    SequenceSources,
    testing::Values("vase-flight", "rally-flight", "rally-play", "gallery-play"),
    [](const auto& instance) {
        std::string name = instance.param;
        std::replace(name.begin(), name.end(), '-', '_');
        return name;
    }
);

} // namespace
} // namespace shutter::bench
