// SPDX-License-Identifier: MIT
// Flythroughs in files, and ramps of time.
#include "engine/flythrough/flythrough.h"
#include "engine/flythrough/time_ramp.h"
#include "engine/scene/motion.h"
#include "tests/support/outcomes.h"
#include "tests/support/rows.h"
#include "tests/support/temp_folder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace shutter::flythrough {
namespace {

using test::TempFolder;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

FlythroughKey key(double seconds, const math::dvec3& position) {
    FlythroughKey made;
    made.seconds = seconds;
    made.position = position;
    made.lookAt = math::dvec3(0.0);
    return made;
}

/// Every field in use.
Flythrough makeFull() {
    Flythrough flythrough;
    flythrough.name = "Kamerafahrt \u00e4";
    flythrough.fps = {30000.0, 1001.0};
    flythrough.interpolation = scene::PathInterpolation::Linear;
    flythrough.ease = scene::PathEase::InOut;
    flythrough.up = {0.1, 1.0, -0.0};
    flythrough.keys = {key(-1.5, {0.1, 1.0 / 3.0, 3.0}), key(0.25, {1, 2, 3}), key(2, {3, 2, 1})};
    for (FlythroughKey& each : flythrough.keys) {
        each.lookAt.reset();
        each.rotation = glm::normalize(math::dquat(0.7, 0.1, -0.3, 0.2 + each.seconds));
        each.fieldOfView = 40.0 + each.seconds;
        each.focusDistance = 3.0 + each.seconds;
        each.fStop = 4.0 + each.seconds;
    }
    flythrough.keys[0].shutter = FlythroughShutter{1.0 / 60.0, {}, {}};
    flythrough.keys[1].shutter = FlythroughShutter{{}, 180.0, scene::ShutterPhase::Centre};
    flythrough.keys[2].shutter = FlythroughShutter{{}, {}, scene::ShutterPhase::Start};
    flythrough.keys[2].cut = true;
    flythrough.keys[0].timeScale = 1.0 / 3.0;
    flythrough.keys[2].timeScale = 2.0;
    return flythrough;
}

std::string errorOf(const std::string& text) {
    return test::errorOf(parseFlythrough(text, "f.json"));
}

std::string readText(const std::filesystem::path& path) {
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

TEST(Flythrough, AFlythroughIsReadBackBitForBit) {
    const TempFolder folder;
    const auto path = folder.path() / "f.json";
    const Flythrough written = makeFull();
    ASSERT_TRUE(writeFlythrough(path, written).ok());
    const Flythrough again = test::valueOf(readFlythrough(path));
    EXPECT_EQ(again.name, written.name);
    EXPECT_EQ(again.fps, written.fps);
    EXPECT_EQ(again.interpolation, written.interpolation);
    EXPECT_EQ(again.ease, written.ease);
    EXPECT_EQ(again.up, written.up);
    ASSERT_EQ(again.keys.size(), written.keys.size());
    for (size_t i = 0; i < written.keys.size(); ++i) {
        EXPECT_EQ(again.keys[i].seconds, written.keys[i].seconds);
        EXPECT_EQ(again.keys[i].position, written.keys[i].position);
        EXPECT_EQ(again.keys[i].rotation, written.keys[i].rotation);
        EXPECT_EQ(again.keys[i].fieldOfView, written.keys[i].fieldOfView);
        EXPECT_EQ(again.keys[i].focusDistance, written.keys[i].focusDistance);
        EXPECT_EQ(again.keys[i].fStop, written.keys[i].fStop);
        EXPECT_EQ(again.keys[i].cut, written.keys[i].cut);
        EXPECT_EQ(again.keys[i].timeScale, written.keys[i].timeScale);
        ASSERT_TRUE(again.keys[i].shutter.has_value());
        EXPECT_EQ(again.keys[i].shutter->exposureSeconds, written.keys[i].shutter->exposureSeconds);
        EXPECT_EQ(again.keys[i].shutter->angleDegrees, written.keys[i].shutter->angleDegrees);
        EXPECT_EQ(again.keys[i].shutter->phase, written.keys[i].shutter->phase);
    }
    ASSERT_TRUE(writeFlythrough(folder.path() / "g.json", again).ok());
    EXPECT_EQ(readText(path), readText(folder.path() / "g.json"));
}

TEST(Flythrough, TheRateIsANumberOrAFractionAndOnlyAVersionAndAKeyAreRequired) {
    const auto read = [](const std::string& fps) {
        return parseFlythrough(
            R"({"version": 1, "fps": )" + fps +
                R"(, "keys": [{"time": 0, "position": [0, 1, 2], "lookAt": [0, 0, 0]}]})",
            "f"
        );
    };
    EXPECT_EQ(read("\"24000/1001\"").value().fps, core::FrameRate(24000.0, 1001.0));
    EXPECT_EQ(read("29.97").value().fps, core::FrameRate(29.97));
    for (const std::string& wrong :
         test::rowsOf(R"("24"|"24/0"|"0/1"|"1001/1"|"-24/1"|"x"|[24000, 1001]|0)"))
        test::expectRefused(read(wrong), "f:1: fps: ");
    const auto least = test::valueOf(parseFlythrough(
        R"({"version": 1, "keys": [{"time": 0, "position": [0, 1, 2], "lookAt": [0, 0, 0]}]})", "f"
    ));
    EXPECT_EQ(least.fps, 24.0);
    EXPECT_EQ(least.interpolation, scene::PathInterpolation::CatmullRom);
    EXPECT_EQ(least.ease, scene::PathEase::None);
    EXPECT_FALSE(makeLens(least).has_value());
    EXPECT_TRUE(scene::validatePath(makePath(least)).ok());
}

TEST(Flythrough, FaultsBeyondTheSchemaAreRefusedByName) {
    const std::string first =
        "{\"time\": 1, \"position\": [0, 0, 0], \"lookAt\": [0, 0, 1], \"fieldOfView\": 40},\n";
    const std::pair<std::string, const char*> kFaults[] = {
        {first + R"({"time": 1, "position": [0, 0, 0], "lookAt": [0, 0, 1], "fieldOfView": 40})",
         "f.json:4: keys[1].time: must come after the key before, at 1 s"},
        {first +
             R"({"time": 2, "position": [0, 0, 0], "rotation": [0, 0, 0, 1], "fieldOfView": 4})",
         "f.json:4: keys[1]: must have lookAt as the first key has"},
        {first + R"({"time": 2, "position": [0, 0, 0], "lookAt": [0, 0, 0]})",
         "f.json:4: keys[1]: must have fieldOfView, as the first key has one"},
        {R"({"time": 2, "position": [0, 0, 0], "rotation": [0, 0, 0.9, 0]})",
         "f.json:3: keys[0].rotation: must be of length 1 (x, y, z, w), not 0.9"},
        {R"({"time": 2, "position": [0, 0, 0]})",
         "f.json:3: keys[0]: must have either lookAt or rotation"}};
    for (const auto& [keys, sentence] : kFaults)
        EXPECT_EQ(errorOf("{\"version\": 1,\n\"keys\": [\n" + keys + "]}"), sentence);
    EXPECT_EQ(
        errorOf("{\"version\": 1, \"up\": [0, 0, 0], \"keys\": []}"),
        "f.json:1: up: must have a direction"
    );
}

TEST(Flythrough, AWrongOneIsNotWritten) {
    const TempFolder folder;
    const auto path = folder.path() / "f.json";
    const auto refuses = [&](auto change, const std::string& mention) {
        Flythrough wrong = makeFull();
        change(wrong);
        test::expectRefused(writeFlythrough(path, wrong), mention);
        EXPECT_FALSE(std::filesystem::exists(path));
    };
    refuses([](Flythrough& f) { f.keys.clear(); }, "keys: must have at least 1");
    refuses([](Flythrough& f) { f.fps = 0.0; }, "fps: must lie in (0, 1000]");
    refuses([](Flythrough& f) { f.fps = kNan; }, "fps and up");
    refuses([](Flythrough& f) { f.keys[1].seconds = -1.5; }, "keys[1].time");
    refuses([](Flythrough& f) { f.keys[1].position.y = kNan; }, "keys[1]");
    refuses([](Flythrough& f) { f.keys[2].fieldOfView = 180.0; }, "keys[2].fieldOfView");
    for (const double bad : {0.0, -1.0, kNan, std::numeric_limits<double>::infinity()}) {
        refuses([&](Flythrough& f) { f.keys[2].focusDistance = bad; }, "keys[2]");
        refuses([&](Flythrough& f) { f.keys[2].fStop = bad; }, "keys[2]");
    }
    refuses(
        [](Flythrough& f) { f.keys[1].fStop.reset(); },
        "keys[1]: must have fStop, as the first key has one"
    );
    refuses([](Flythrough& f) { f.keys[2].rotation.reset(); }, "keys[2]");
    refuses([](Flythrough& f) { f.keys[0].shutter->angleDegrees = 1.0; }, "exclude each other");
    refuses([](Flythrough& f) { f.keys[0].shutter = FlythroughShutter{}; }, "none of exposure");
}

TEST(Flythrough, TheCameraFollowsItsKeys) {
    scene::World world;
    const Flythrough flythrough = makeFull();
    const ecs::Entity camera = addFlythroughCamera(world, flythrough);
    EXPECT_EQ(world.cameras, std::vector<ecs::Entity>{camera});
    for (const FlythroughKey& each : flythrough.keys) {
        const math::dmat4 pose = scene::worldFromEntity(world, camera, each.seconds);
        EXPECT_LT(glm::length(math::dvec3(pose[3]) - each.position), 1e-12);
        const math::dvec3 forward = *each.rotation * math::dvec3(0, 0, -1);
        EXPECT_LT(glm::length(math::dvec3(pose[2]) + forward), 1e-12);
        EXPECT_NEAR(
            scene::yFovAt(world, camera, each.seconds),
            *each.fieldOfView * std::numbers::pi / 180.0,
            1e-12
        );
    }
    // The cut is the path's and the lens's.
    EXPECT_EQ(
        scene::worldFromEntity(world, camera, 1.99), scene::worldFromEntity(world, camera, 0.25)
    );
    EXPECT_EQ(scene::yFovAt(world, camera, 1.99), scene::yFovAt(world, camera, 0.25));
}

TEST(Flythrough, TheDefaultFieldOfViewIsTheFirstCameras) {
    scene::World world;
    Flythrough flythrough;
    flythrough.keys = {key(0, {0, 0, 5})};
    const auto fovOf = [&](ecs::Entity camera) { return scene::yFovAt(world, camera, 0.0); };
    EXPECT_EQ(fovOf(addFlythroughCamera(world, flythrough)), scene::Camera{}.yFov);
    auto& first = world.registry.get<scene::Camera>(world.cameras.front());
    first.yFov = 0.5;
    first.near = 0.25;
    first.aspectRatio = 2.39;
    const ecs::Entity second = addFlythroughCamera(world, flythrough);
    EXPECT_EQ(fovOf(second), 0.5);
    EXPECT_EQ(world.registry.get<scene::Camera>(second).near, 0.25);
    EXPECT_EQ(world.registry.get<scene::Camera>(second).aspectRatio, 2.39);
    // A field of view makes a perspective camera of it.
    world.registry.get<scene::Camera>(world.cameras.front()).kind = scene::CameraKind::Orthographic;
    flythrough.keys[0].fieldOfView = 90.0;
    const ecs::Entity third = addFlythroughCamera(world, flythrough);
    EXPECT_NEAR(fovOf(third), std::numbers::pi / 2.0, 1e-15);
    EXPECT_FALSE(world.registry.get<scene::Camera>(third).aspectRatio) << "it is the picture's";
}

TEST(Flythrough, TheLensIsFocusedByTheKeysAndElseTheFirstCameras) {
    Flythrough flythrough = makeFull();
    scene::World world;
    const ecs::Entity first = world.registry.create();
    world.registry.add(first, scene::Camera{});
    world.registry.add(first, scene::CameraLens{.fStop = 9.0, .blades = 5});
    world.cameras.push_back(first);
    const ecs::Entity full = addFlythroughCamera(world, flythrough);
    for (const FlythroughKey& each : flythrough.keys) {
        const scene::CameraLens lens = scene::lensAt(world, full, each.seconds);
        EXPECT_NEAR(lens.focusDistance, *each.focusDistance, 1e-12);
        EXPECT_NEAR(lens.fStop, *each.fStop, 1e-12);
        EXPECT_EQ(lens.blades, 5u);
    }
    EXPECT_NEAR(scene::lensAt(world, full, 1.99).fStop, 4.25, 1e-12) << "the last key is a cut";
    for (FlythroughKey& each : flythrough.keys)
        each.fStop.reset();
    EXPECT_EQ(scene::lensAt(world, addFlythroughCamera(world, flythrough), 2.0).fStop, 9.0);
    for (FlythroughKey& each : flythrough.keys)
        each.focusDistance.reset();
    EXPECT_FALSE(makeFocus(flythrough).has_value());
}

TEST(Flythrough, AShutterStandsFromItsKeyToTheNext) {
    const Flythrough flythrough = makeFull();
    const auto at = [&](double seconds) {
        scene::CameraShutter shutter{.exposureSeconds = 9.0};
        applyShutter(flythrough, seconds, shutter);
        return shutter;
    };
    for (const double before : {-9.0, -1.5, 0.2}) {
        EXPECT_EQ(at(before).mode, scene::ShutterMode::Physical);
        EXPECT_EQ(at(before).exposureSeconds, 1.0 / 60.0);
        EXPECT_EQ(at(before).phase, scene::ShutterPhase::End);
    }
    EXPECT_EQ(at(0.25).mode, scene::ShutterMode::Angle);
    EXPECT_EQ(at(1.9).angleDegrees, 180.0);
    EXPECT_EQ(at(1.9).phase, scene::ShutterPhase::Centre);
    // The last has only a phase: the rest is the caller's.
    EXPECT_EQ(at(2.0).phase, scene::ShutterPhase::Start);
    EXPECT_EQ(at(2.0).exposureSeconds, 9.0);
    Flythrough silent = flythrough;
    for (FlythroughKey& each : silent.keys)
        each.shutter.reset();
    scene::CameraShutter shutter{.exposureSeconds = 9.0};
    applyShutter(silent, 0.0, shutter);
    EXPECT_EQ(shutter.exposureSeconds, 9.0);
}

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

TEST(TimeRamp, FilmTimeEqualsSceneTimeWithoutScales) {
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

TEST(TimeRamp, ASingleScaleAppliesToAllTimeAndToALengthInSeconds) {
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
    scene::CameraShutter shutter;
    shutter.mode = scene::ShutterMode::Physical;
    shutter.exposureSeconds = 0.02;
    const auto lasting = makeRamp({{0.0, 0.5}}).computeExposure(shutter, 1.0, kFrame);
    EXPECT_NEAR(lasting.close - lasting.open, 0.01, 1.0e-12);
    shutter.exposureSeconds = 0.0;
    const auto sharp = makeRamp({{0.0, 0.5}}).computeExposure(shutter, 1.0, kFrame);
    EXPECT_EQ(sharp.open, 1.0);
    EXPECT_EQ(sharp.close, 1.0);
}

TEST(TimeRamp, FilmTimeIsTheSumOfSceneTimeOverItsScale) {
    // Down to a tenth, up to twice, with a key without a scale between.
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

} // namespace
} // namespace shutter::flythrough
