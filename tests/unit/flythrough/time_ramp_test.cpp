// SPDX-License-Identifier: MIT
#include "engine/flythrough/time_ramp.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <utility>
#include <vector>

namespace shutter::flythrough {
namespace {

using Scales = std::vector<std::pair<double, std::optional<double>>>;

constexpr double kFrame = 1.0 / 24.0;

TimeRamp makeRamp(const Scales& scales) {
    Flythrough flythrough;
    for (const auto& [seconds, scale] : scales) {
        FlythroughKey& key = flythrough.keys.emplace_back();
        key.seconds = seconds;
        key.lookAt = math::dvec3(0.0, 0.0, -1.0);
        key.timeScale = scale;
    }
    return TimeRamp(flythrough);
}

scene::CameraShutter openFor(double degrees, scene::ShutterPhase phase) {
    scene::CameraShutter shutter;
    shutter.mode = scene::ShutterMode::Angle;
    shutter.angleDegrees = degrees;
    shutter.phase = phase;
    return shutter;
}

TEST(TimeRamp, WithoutScalesBothTimesAreTheSameToTheBit) {
    const TimeRamp ramp = makeRamp({{0.0, std::nullopt}, {3.0, std::nullopt}});
    for (const double seconds : {-1.0, 0.0, 0.1, 1.0 / 3.0, 1.0e9}) {
        EXPECT_EQ(ramp.filmFromScene(seconds), seconds);
        EXPECT_EQ(ramp.sceneFromFilm(seconds), seconds);
        EXPECT_EQ(ramp.scaleAt(seconds), 1.0);
    }
    const auto shutter = openFor(180.0, scene::ShutterPhase::Centre);
    const auto own = ramp.computeExposure(shutter, 1.0 / 3.0, kFrame);
    const auto plain = scene::computeExposure(shutter, 1.0 / 3.0, kFrame);
    EXPECT_EQ(own.open, plain.open);
    EXPECT_EQ(own.close, plain.close);
    EXPECT_EQ(own.rasterTime, plain.rasterTime);
}

TEST(TimeRamp, OneScaleHoldsForAllTime) {
    const TimeRamp ramp = makeRamp({{1.0, 0.25}});
    for (const double seconds : {-2.0, 0.0, 0.5, 1.0, 7.0}) {
        EXPECT_NEAR(ramp.filmFromScene(seconds), 4.0 * seconds, 1.0e-12);
        EXPECT_NEAR(ramp.sceneFromFilm(4.0 * seconds), seconds, 1.0e-12);
    }
    // A quarter of the exposure of a film at full speed, and of its frame.
    const auto exposure =
        ramp.computeExposure(openFor(180.0, scene::ShutterPhase::Centre), 2.0, kFrame);
    EXPECT_NEAR(exposure.close - exposure.open, kFrame / 8.0, 1.0e-12);
    EXPECT_NEAR(exposure.frameSeconds, kFrame / 4.0, 1.0e-12);
    EXPECT_NEAR(exposure.rasterTime, 0.5, 1.0e-9);
    EXPECT_EQ(exposure.raster, 2.0);
}

TEST(TimeRamp, FilmTimeIsTheSumOfSceneTimeOverItsScale) {
    // Down to a tenth, up to twice, with a key between that tells nothing.
    const TimeRamp ramp =
        makeRamp({{-1.0, 1.0}, {0.5, 0.1}, {1.0, std::nullopt}, {2.0, 2.0}, {3.0, 2.0}});
    constexpr int kSteps = 200000;
    constexpr double kStep = 6.0 / kSteps;
    double film = ramp.filmFromScene(-2.0);
    for (int i = 0; i < kSteps; ++i) {
        film += kStep / ramp.scaleAt(-2.0 + (i + 0.5) * kStep);
        if (i % 10000 == 9999) {
            const double scene = -2.0 + (i + 1) * kStep;
            EXPECT_NEAR(ramp.filmFromScene(scene), film, 1.0e-6) << scene;
            EXPECT_NEAR(ramp.sceneFromFilm(ramp.filmFromScene(scene)), scene, 1.0e-9);
        }
    }
    EXPECT_NEAR(ramp.filmFromScene(0.0), 0.0, 1.0e-12);
    EXPECT_NEAR(ramp.scaleAt(1.25), 1.05, 1.0e-12) << "half of the way from 0.1 to 2";
}

TEST(TimeRamp, TimeNeverGoesBackwards) {
    const TimeRamp ramp = makeRamp({{0.0, 0.001}, {1.0, 1000.0}, {1.001, 0.001}, {9.0, 1.0}});
    double before = ramp.sceneFromFilm(-10.0);
    for (double film = -9.99; film < 2000.0; film += 0.37) {
        const double scene = ramp.sceneFromFilm(film);
        ASSERT_TRUE(std::isfinite(scene)) << film;
        EXPECT_GE(scene, before) << film;
        before = scene;
    }
}

TEST(TimeRamp, ExposuresOfAWholeFrameLeaveNoGap) {
    const TimeRamp ramp = makeRamp({{0.0, 1.0}, {0.5, 0.1}, {1.5, 1.0}});
    for (const auto phase :
         {scene::ShutterPhase::Start, scene::ShutterPhase::Centre, scene::ShutterPhase::End}) {
        const auto shutter = openFor(360.0, phase);
        const auto expose = [&](int frame) {
            return ramp.computeExposure(shutter, ramp.sceneFromFilm(frame * kFrame), kFrame);
        };
        for (int frame = -3; frame < 60; ++frame) {
            const auto now = expose(frame);
            EXPECT_NEAR(now.close, expose(frame + 1).open, 1.0e-9) << frame;
            EXPECT_NEAR(now.at(now.rasterTime), now.raster, 1.0e-12);
            EXPECT_NEAR(now.raster - now.frameSeconds, expose(frame - 1).raster, 1.0e-9);
            EXPECT_TRUE(now.open <= now.raster && now.raster <= now.close);
        }
    }
}

TEST(TimeRamp, ALengthInSecondsIsTheFilms) {
    scene::CameraShutter shutter;
    shutter.mode = scene::ShutterMode::Physical;
    shutter.exposureSeconds = 0.02;
    const auto exposure = makeRamp({{0.0, 0.5}}).computeExposure(shutter, 1.0, kFrame);
    EXPECT_NEAR(exposure.close - exposure.open, 0.01, 1.0e-12);
    shutter.exposureSeconds = 0.0;
    const auto sharp = makeRamp({{0.0, 0.5}}).computeExposure(shutter, 1.0, kFrame);
    EXPECT_EQ(sharp.open, 1.0);
    EXPECT_EQ(sharp.close, 1.0);
}

} // namespace
} // namespace shutter::flythrough
