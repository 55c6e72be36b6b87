// SPDX-License-Identifier: MIT
// The demos as a whole, in the scenes that the build makes.
#include "assets/generator/gltf_writer.h"
#include "engine/scene/exposure_motion.h"
#include "engine/scene/history.h"
#include "game/demos/demo.h"
#include "game/demos/gallery_demo.h"
#include "game/demos/rally_demo.h"
#include "game/demos/random.h"
#include "game/demos/spin_demo.h"
#include "game/demos/stage.h"
#include "tests/support/outcomes.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace shutter::game {
namespace {

namespace fs = std::filesystem;

/// Where the build puts the scenes.
fs::path assets() {
    return fs::path(SHUTTER_BUILD_DIR) / "assets";
}

std::unique_ptr<Demo> make(const std::string& name) {
    return test::valueOf(makeDemo(name, assets()));
}

DemoControls randomControls(Random& random) {
    return {
        .turn = random.between(-1.5, 1.5),
        .drive = random.between(-1.0, 1.5),
        .action = random.next() < 0.3,
        .switchCamera = random.next() < 0.02,
        .toggleExclusion = random.next() < 0.02};
}

/// All poses, bit for bit.
std::vector<math::dmat4> poses(const Demo& demo) {
    std::vector<math::dmat4> all;
    for (const ecs::Entity entity : demo.world().registry.entities())
        all.push_back(scene::worldFromEntity(demo.world(), entity, demo.seconds()));
    return all;
}

class EveryDemo : public testing::TestWithParam<const char*> {};

TEST_P(EveryDemo, TheSameControlsGiveTheSameBits) {
    const auto first = make(GetParam());
    const auto second = make(GetParam());
    Random random(17);
    DemoControls controls;
    for (int i = 0; i < kDemoStepsPerSecond * 10; ++i) {
        if (i % 10 == 0)
            controls = randomControls(random);
        first->step(controls);
        second->step(controls);
    }
    EXPECT_EQ(poses(*first), poses(*second));
    EXPECT_EQ(first->score(), second->score());
    EXPECT_EQ(first->camera(), second->camera());
}

TEST_P(EveryDemo, ADemoToleratesAnyControlsForAMinuteAndEnds) {
    const auto demo = make(GetParam());
    Random random(23);
    DemoControls controls;
    bool hasEnded = false;
    int finalScore = 0;
    // The longest of them ends after two minutes.
    for (int i = 0; i < kDemoStepsPerSecond * 122; ++i) {
        if (i % 12 == 0)
            controls = randomControls(random);
        if (i % 1200 == 0)
            controls.turn = controls.drive = std::numeric_limits<double>::quiet_NaN();
        demo->step(controls);
        if (hasEnded) {
            ASSERT_TRUE(demo->isOver());
            ASSERT_EQ(demo->score(), finalScore) << "the score stays";
        }
        hasEnded = demo->isOver();
        finalScore = demo->score();
        if (i % 600 != 0)
            continue;
        for (const math::dmat4& pose : poses(*demo))
            ASSERT_TRUE(math::isFinite(pose)) << demo->seconds() << " s";
    }
    EXPECT_TRUE(hasEnded);
    EXPECT_DOUBLE_EQ(demo->seconds(), 122.0);
    bool shown = false;
    for (const HudLine& line : demo->hud())
        shown = shown ||
                (line.label == "Score" && line.text == std::to_string(finalScore) && line.emphasis);
    EXPECT_TRUE(shown) << "the final score is on the screen";
}

TEST_P(EveryDemo, CamerasChangeByACutAndTheBodyLeavesTheBlur) {
    const auto demo = make(GetParam());
    for (int i = 0; i < 60; ++i)
        demo->step({});
    const ecs::Entity before = demo->camera();
    demo->step({.switchCamera = true});
    EXPECT_NE(demo->camera(), before);
    const double now = demo->seconds();
    EXPECT_TRUE(scene::isCut(demo->world(), demo->camera(), {now - kDemoStepSeconds, now}));
    demo->step({});
    EXPECT_FALSE(scene::isCut(demo->world(), demo->camera(), {now, demo->seconds()}));
    for (size_t i = 1; i < demo->world().cameras.size(); ++i)
        demo->step({.switchCamera = true});
    EXPECT_EQ(demo->camera(), before);

    const auto countExcluded = [&] {
        int count = 0;
        for (auto [entity, blur] :
             std::as_const(*demo).world().registry.view<scene::MotionBlur>()) {
            (void)entity;
            count += blur.exclude;
        }
        return count;
    };
    EXPECT_EQ(countExcluded(), 0);
    demo->step({.toggleExclusion = true});
    EXPECT_EQ(countExcluded(), 1);
    EXPECT_TRUE(demo->isBodyExcluded());
    demo->step({.toggleExclusion = true});
    EXPECT_EQ(countExcluded(), 0);
    EXPECT_FALSE(demo->isBodyExcluded());
}

TEST_P(EveryDemo, ADemoHasATitleAndControlDescriptions) {
    const auto demo = make(GetParam());
    EXPECT_STREQ(demo->name(), GetParam());
    EXPECT_FALSE(demo->isOver());
    ASSERT_GE(demo->hud().size(), 3u);
    EXPECT_EQ(demo->hud().front().label, "Score");
    EXPECT_EQ(demo->hud().front().text, "0");
    for (const DemoInfo& info : listDemos()) {
        if (info.name != std::string_view(GetParam()))
            continue;
        const DemoControlWords& words = info.controls;
        for (const char* word : {words.turn, words.drive, words.action, words.body})
            EXPECT_STRNE(word, "");
    }
}

TEST_P(EveryDemo, ASceneWithoutRequiredNodesIsRefused) {
    const fs::path folder = fs::path(SHUTTER_BUILD_DIR) / "test_demo_scenes";
    fs::create_directories(folder);
    const std::string name = GetParam();
    generator::GltfWriter writer("empty");
    writer.addNode({.name = "nothing"});
    ASSERT_EQ(writer.write(folder / (name + ".glb")), "");
    test::expectRefused(makeDemo(name, folder), name + ".glb: it has no node '");
}

INSTANTIATE_TEST_SUITE_P(
    Demos,
    EveryDemo,
    testing::Values("rally", "gallery", "spin"),
    [](const auto& instance) { return std::string(instance.param); }
);

TEST(Demos, DemosAreListedAndOtherNamesRefused) {
    for (const DemoInfo& info : listDemos())
        EXPECT_STREQ(make(info.name)->name(), info.name);
    EXPECT_EQ(listDemos().size(), 3u);
    EXPECT_EQ(
        test::errorOf(makeDemo("chess", assets())), "demo 'chess' is none of: rally, gallery, spin"
    );
}

/// Plays game/demos/scripts/NAME.json: left stick turns, right stick drives, space is the action.
void playScript(Demo& demo) {
    const fs::path file =
        fs::path(SHUTTER_SOURCE_DIR) / "game/demos/scripts" / (std::string(demo.name()) + ".json");
    std::ifstream stream(file);
    const nlohmann::json script = nlohmann::json::parse(stream, nullptr, false);
    ASSERT_FALSE(script.is_discarded()) << file;
    const auto& events = script["events"];
    DemoControls controls;
    size_t next = 0;
    for (int frame = 0; !demo.isOver(); ++frame) {
        for (; next < events.size() && events[next]["time"] <= frame / 30.0; ++next) {
            const auto& event = events[next];
            if (event.contains("leftStick"))
                controls.turn = event["leftStick"][0];
            else if (event.contains("rightStick"))
                controls.drive = event["rightStick"][1];
            else if (event.value("key", "") == "space")
                controls.action = event["action"] == "press";
        }
        for (int i = 0; i < kDemoStepsPerSecond / 30; ++i)
            demo.step(controls);
    }
}

TEST(DemoScripts, DriveTwoLapsOfTheRally) {
    const auto demo = make("rally");
    playScript(*demo);
    const auto& rally = dynamic_cast<const RallyDemo&>(*demo);
    EXPECT_EQ(rally.progress().lap, 2);
    EXPECT_EQ(rally.progress().gatesPassed, 28);
    EXPECT_GT(demo->score(), 2000);
}

TEST(DemoScripts, HitTargetsOfTheGallery) {
    const auto demo = make("gallery");
    playScript(*demo);
    const auto& gallery = dynamic_cast<const GalleryDemo&>(*demo);
    EXPECT_GE(gallery.hitCount(), 10);
    EXPECT_LE(gallery.hitCount(), gallery.throwCount());
    EXPECT_GT(demo->score(), 400);
}

TEST(DemoScripts, CatchRingsOfTheCarousel) {
    const auto demo = make("spin");
    playScript(*demo);
    EXPECT_GE(dynamic_cast<const SpinDemo&>(*demo).rules().caught, 5);
    EXPECT_GT(demo->score(), 500);
}

TEST(RallyMotion, AnExposureKnowsTheCarItsWheelsAndItsCameras) {
    const auto demo = make("rally");
    for (int i = 0; i < kDemoStepsPerSecond * 3; ++i)
        demo->step({.turn = 0.2, .drive = 1.0});
    NodeNames names(demo->world());
    const ecs::Entity wheel = names.find("spokes_front_left");
    scene::CameraShutter shutter;
    shutter.exposureSeconds = 1.0 / 60.0;
    const scene::ExposureMotion motion(
        demo->world(), demo->camera(), scene::computeExposure(shutter, demo->seconds(), 1.0 / 30.0)
    );
    const double speed = dynamic_cast<const RallyDemo&>(*demo).car().speed();
    ASSERT_GT(speed, 10.0);
    EXPECT_FALSE(motion.isCut());
    for (const ecs::Entity entity : {wheel, names.find("car_body"), demo->camera()}) {
        const math::dvec3 way = math::dvec3(motion.worldFromEntity(entity, 1.0)[3]) -
                                math::dvec3(motion.worldFromEntity(entity, 0.0)[3]);
        EXPECT_NEAR(glm::length(way), speed / 60.0, 0.1 * speed / 60.0);
    }
    const auto spoke = [&](double s) { return math::dvec3(motion.worldFromEntity(wheel, s)[1]); };
    EXPECT_NEAR(std::acos(glm::dot(spoke(0.0), spoke(1.0))), speed / kWheelRadius / 60.0, 0.1);
}

} // namespace
} // namespace shutter::game
