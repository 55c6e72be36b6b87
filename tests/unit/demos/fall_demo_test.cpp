// SPDX-License-Identifier: MIT
// The demo of game/demos/README.md, in a scene of its own.
#include "assets/generator/gltf_writer.h"
#include "engine/scene/history.h"
#include "tests/support/outcomes.h"
#include "tests/unit/demos/fall_demo.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <memory>
#include <string>

namespace shutter::game {
namespace {

namespace fs = std::filesystem;

constexpr float kRestHeight = 5.0f;

/// A scene in a folder of its own, as `--assets FOLDER` takes it.
fs::path writeScene(const std::string& name, bool hasBall, bool hasCamera) {
    const fs::path folder = fs::path(SHUTTER_BUILD_DIR) / "test_fall_demo";
    fs::create_directories(folder);
    generator::GltfWriter writer(name);
    writer.addNode({.name = hasBall ? "ball" : "cube", .translation = {0.0f, kRestHeight, 0.0f}});
    if (hasCamera)
        writer.addNode({.name = "camera", .camera = writer.addCamera("camera", 0.8f, 0.1f)});
    const fs::path file = folder / (name + ".glb");
    EXPECT_EQ(writer.write(file), "");
    return file;
}

core::Result<std::unique_ptr<Demo>> load(const fs::path& file) {
    return FallDemo::create(test::valueOf(loadDemoScene(file)), file.string());
}

double heightAt(const Demo& demo, ecs::Entity ball, double seconds) {
    return scene::worldFromEntity(demo.world(), ball, seconds)[3].y;
}

TEST(FallDemo, ItsBallFallsAndComesAgainByAJump) {
    const auto demo = test::valueOf(load(writeScene("fall", true, true)));
    const ecs::Entity ball = NodeNames(demo->world()).find("ball");
    while (demo->score() == 0 && !demo->isOver()) {
        EXPECT_LE(heightAt(*demo, ball, demo->seconds()), kRestHeight);
        demo->step({});
    }
    ASSERT_EQ(demo->score(), 1);
    EXPECT_NEAR(demo->seconds(), std::sqrt(2.0 * kRestHeight / kGravity), 0.02);
    EXPECT_NEAR(heightAt(*demo, ball, demo->seconds()), kRestHeight, 1e-9);
    // It is at the ground up to the jump, nowhere in between.
    EXPECT_LT(heightAt(*demo, ball, demo->seconds() - 0.5 * kDemoStepSeconds), 0.1);
    EXPECT_EQ(demo->hud().front().text, "1");
}

TEST(FallDemo, AfterTheEndItMovesOnAndTheScoreStays) {
    const auto demo = test::valueOf(load(writeScene("fall", true, true)));
    while (!demo->isOver())
        demo->step({.turn = 0.5});
    const int score = demo->score();
    EXPECT_GT(score, 25);
    for (int i = 0; i < 5 * kDemoStepsPerSecond; ++i)
        demo->step({});
    EXPECT_EQ(demo->score(), score);
}

TEST(FallDemo, ASceneWithoutBallOrCameraIsRefused) {
    test::expectRefused(
        load(writeScene("no_ball", false, true)), "no_ball.glb: it has no node 'ball'"
    );
    test::expectRefused(
        load(writeScene("no_camera", true, false)), "no_camera.glb: it has no camera"
    );
}

} // namespace
} // namespace shutter::game
