// SPDX-License-Identifier: MIT
// Where films come from, and errors between their frames.
#include "engine/scene/camera.h"
#include "engine/scene/lens.h"
#include "engine/scene/motion.h"
#include "game/bench/sequence/sequence_source.h"
#include "game/bench/sequence/temporal_error.h"
#include "tests/kit/sweep.h"
#include "tests/support/outcomes.h"
#include "tests/support/temp_folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace shutter::bench {
namespace {

using image::Image;
using test::TempFolder;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

Image makeFlat(float value, uint32_t width = 16, uint32_t height = 12) {
    Image picture(width, height, 3);
    std::fill(picture.pixels.begin(), picture.pixels.end(), value);
    return picture;
}

/// `base` and a checkerboard of +-amplitude, of which every pixel changes its sign with `phase`.
Image addCheckerboard(Image base, float amplitude, uint32_t phase = 0) {
    for (uint32_t y = 0; y < base.height; ++y)
        for (uint32_t x = 0; x < base.width; ++x)
            for (uint32_t c = 0; c < 3; ++c)
                base.at(x, y, c) += (x + y + phase) % 2 == 0 ? amplitude : -amplitude;
    return base;
}

Image addNoise(Image base, float amplitude, std::mt19937& random) {
    std::uniform_real_distribution<float> noise(-amplitude, amplitude);
    for (float& value : base.pixels)
        value += noise(random);
    return base;
}

TEST(Flicker, NeitherChangesOfTheTruthNorAnErrorThatStaysIsFlicker) {
    const Image dark = makeFlat(0.25f);
    const Image bright = makeFlat(0.75f);
    EXPECT_EQ(computeFlicker({dark, dark}, {dark, dark}), 0.0);
    EXPECT_EQ(computeFlicker({dark, dark}, {bright, bright}), 0.0);
    const Image darkError = addCheckerboard(dark, 0.125f);
    EXPECT_EQ(computeFlicker({darkError, dark}, {addCheckerboard(bright, 0.125f), bright}), 0.0);
}

TEST(Flicker, FlickerIsTheMeanChangeThatTheTruthLacksAndANaNTheLargest) {
    const Image truth = makeFlat(0.5f);
    const Image up = addCheckerboard(truth, 0.125f, 0);
    const Image down = addCheckerboard(truth, 0.125f, 1);
    EXPECT_EQ(computeFlicker({up, truth}, {down, truth}), 0.25);
    // A picture that stays as it is while the truth moves flickers as well.
    EXPECT_EQ(computeFlicker({truth, up}, {truth, down}), 0.25);
    const Image small = makeFlat(0.5f, 2, 1);
    Image broken = small;
    broken.at(0, 0, 0) = kNaN;
    EXPECT_EQ(computeFlicker({small, small}, {broken, small}), 2.0 / 6.0);
}

TEST(FixedNoise, ACheckerboardOrANaNIsFixedNoiseAndASlopeIsNot) {
    const Image truth = makeFlat(0.5f);
    const Image fine = computeFineError(addCheckerboard(truth, 0.125f), truth);
    EXPECT_EQ(fine.width, truth.width - 2);
    for (const float value : fine.pixels)
        EXPECT_EQ(std::abs(value), 0.125f);
    Image slope = truth;
    for (uint32_t y = 0; y < slope.height; ++y)
        for (uint32_t x = 0; x < slope.width; ++x)
            slope.at(x, y, 1) += 0.0625f + 0.015625f * float(x) - 0.0078125f * float(y);
    for (const float value : computeFineError(slope, truth).pixels)
        EXPECT_EQ(value, 0.0f);
    const Image small = makeFlat(0.5f, 3, 3);
    Image broken = small;
    broken.at(1, 1, 0) = kNaN;
    EXPECT_EQ(computeFineError(broken, small).at(0, 0, 0), 0.5f);
    EXPECT_EQ(computeFineError(makeFlat(0.5f, 2, 9), makeFlat(0.5f, 2, 9)).pixels.size(), 0u);
}

TEST(FixedNoise, FixedNoiseIsTheAmplitudeOfAPatternThatKeepsItsSign) {
    // Over a truth that changes, as when a camera flies behind a dirty window.
    const Image fine[] = {
        computeFineError(addCheckerboard(makeFlat(0.25f), 0.125f), makeFlat(0.25f)),
        computeFineError(addCheckerboard(makeFlat(0.75f), 0.125f), makeFlat(0.75f))};
    const double powers[] = {computeFixedPower(fine[0], fine[1])};
    EXPECT_EQ(computeFixedNoise(powers), 0.125);
    const double alternating[] = {-0.25, 0.125};
    EXPECT_EQ(computeFixedNoise(alternating), 0.0);
    EXPECT_EQ(computeFixedNoise({}), 0.0);
}

TEST(FixedNoise, FixedNoiseIsZeroForIndependentNoise) {
    std::mt19937 random(3);
    const Image truth = makeFlat(0.5f, 128, 128);
    const Image a = computeFineError(addNoise(truth, 0.125f, random), truth);
    const Image b = computeFineError(addNoise(truth, 0.125f, random), truth);
    const double own = computeFixedPower(a, a);
    EXPECT_GT(own, 0.001);
    EXPECT_LT(std::abs(computeFixedPower(a, b)), 0.02 * own);
}

TEST(FilmPsnr, FilmPsnrAveragesSquaresAndNotDecibels) {
    const double equal[] = {30.0, 30.0};
    EXPECT_NEAR(computeFilmPsnr(equal), 30.0, 1e-12);
    const double apart[] = {20.0, std::numeric_limits<double>::infinity()};
    EXPECT_NEAR(computeFilmPsnr(apart), 10.0 * std::log10(200.0), 1e-12);
    const double perfect[] = {std::numeric_limits<double>::infinity()};
    EXPECT_TRUE(std::isinf(computeFilmPsnr(perfect)));
}

constexpr uint32_t kFrames = 6;

class SequenceSources : public testing::TestWithParam<const char*> {
  protected:
    void SetUp() override {
        std::filesystem::create_directories(mFolder.path() / "scenes");
        for (SequenceCase& film : makeSequenceSuite().sequences)
            if (film.name == GetParam())
                mFilm = film;
        ASSERT_EQ(mFilm.name, GetParam());
        auto files = test::valueOf(writeSequenceFiles(mFilm, mFolder.path()));
        mFiles = files;
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

TEST_P(SequenceSources, FilmsGoTheSameWayTwiceAndAStandingCameraStaysWhereTheirOwnWas) {
    const auto scout = open();
    const auto again = open();
    double last = -1.0;
    for (uint32_t i = 0; i < kFrames; ++i) {
        scout->advance();
        again->advance();
        const double seconds = scout->view().exposure.raster;
        if (i > 0) {
            EXPECT_NEAR(seconds - last, scout->framesPerSecond().secondsOf(1.0), 1e-9);
        }
        last = seconds;
        EXPECT_EQ(again->view().exposure.raster, seconds);
        EXPECT_EQ(differenceOf(placeOf(*again), placeOf(*scout)), 0.0);
    }
    const scene::ExposureInterval exposure = scout->view().exposure;
    EXPECT_GT(exposure.close - exposure.open, 0.0) << "a sharp film has nothing to judge";
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
        EXPECT_EQ(scene::hasLens(source->world(), view.camera), source->hasLens());
        const double seconds = view.exposure.raster;
        EXPECT_EQ(
            scene::lensAt(source->world(), view.camera, seconds).focusDistance,
            there.opening.focusDistance
        );
    }
}

/// By default a flight with a lens and a demo that is played: their scenes are the largest cost.
std::vector<const char*> chooseFilms() {
    if (test::drawsAll())
        return {"vase-flight", "rally-flight", "gallery-focus", "rally-play", "gallery-play"};
    return {"gallery-focus", "rally-play"};
}

INSTANTIATE_TEST_SUITE_P(
    FlightsAndDemos,
    SequenceSources,
    testing::ValuesIn(chooseFilms()),
    [](const auto& instance) {
        std::string name = instance.param;
        std::replace(name.begin(), name.end(), '-', '_');
        return name;
    }
);

} // namespace
} // namespace shutter::bench
