// SPDX-License-Identifier: MIT
// Entities without a past are sharp, and entities that jump during an exposure are in each of their
// places for their share of the light, in every method.
#include "engine/image/metrics.h"
#include "engine/scene/history.h"
#include "tests/image/laws.h"
#include "tests/support/deformed_meshes.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/picture.h"
#include "tests/support/stage.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

namespace shutter {
namespace {

using math::vec4;
using scene::AnimationPath;
using scene::Interpolation;
using test::SceneBuilder;
using test::Shot;
using test::Stage;

class HistoryLaw : public test::RayTest {
  protected:
    /// Frames of 0.1 s at t = 1, exposed from 0.96 to 1.04 s.
    static image::Image draw(Stage& stage, std::string_view method, double frameSeconds = 0.1) {
        return stage
            .render(
                {.method = method,
                 .seconds = 1.0,
                 .exposureSeconds = 0.08,
                 .frameSeconds = frameSeconds}
            )
            .color;
    }

    /// With frames of no duration there is no exposure: the sharp picture of the same method.
    static void expectSharp(Stage& stage, const std::string& what, bool sharp) {
        std::vector<std::string_view> methods = test::pickMethods(
            test::listRasterMethods(device()), {"accumulate", "hybrid", "resolved"}
        );
        methods.emplace_back("truth");
        for (const std::string_view method : methods)
            if (method != "sharp") {
                EXPECT_EQ(test::sameBits(draw(stage, method), draw(stage, method, 0.0)), sharp)
                    << what << ", " << method;
            }
    }

    /// In every method that blurs, a share of one picture and the rest of another. `truth` draws a
    /// jump out over 1/1024 of the exposure: one of a pixel's 16 rays may be on its other side.
    static void
    expectMean(Stage& stage, const image::Image& one, double share, const image::Image& other) {
        // All blurs draw the exposure in parts; what they draw of each differs most in these two.
        std::vector<std::string_view> methods =
            test::pickMethods(test::listBlurMethods(device()), {"hybrid", "resolved"});
        methods.insert(methods.end(), {"accumulate", "truth"});
        for (const std::string_view method : methods) {
            const image::Image picture = draw(stage, method);
            const double rays = method == "truth" ? 1.0 / 16.0 : 0.0;
            double most = 0.0;
            for (size_t i = 0; i < picture.pixels.size(); ++i) {
                const double expected = std::lerp(other.pixels[i], one.pixels[i], share);
                const double off = std::abs(double{picture.pixels[i]} - expected);
                const double jump = std::abs(double{one.pixels[i]} - other.pixels[i]);
                most = std::max(most, off - rays * jump);
            }
            EXPECT_LT(most, 0.01) << method;
        }
    }
};

struct PastScene {
    SceneBuilder builder = test::makeWavyRoom(5.0, 9.0, 7.0);
    ecs::Entity parent;
    ecs::Entity mover;

    explicit PastScene(const math::dvec3& cameraTurn) {
        mover = test::addBox(
            builder,
            {0.8, 0.8, 0.8},
            {0.9f, 0.2f, 0.1f},
            {.position = {-2.5, 0, -2.5}, .velocity = {2.5, 0.2, 0}}
        );
        parent = builder.world.registry.create();
        builder.world.registry.add(mover, scene::Parent{parent});
        builder.moveCamera({.angularVelocity = cameraTurn});
    }
};

TEST_F(HistoryLaw, AppearedOrTeleportedEntitiesAreSharpForThatFrame) {
    const std::vector<std::pair<std::string, std::function<void(PastScene&)>>> events = {
        {"appeared", [](PastScene& s) { scene::appear(s.builder.world, s.mover, 0.95); }},
        {"appeared before the shutter opened",
         [](PastScene& s) { scene::appear(s.builder.world, s.mover, 0.91); }},
        {"its parent was teleported",
         [](PastScene& s) { scene::teleport(s.builder.world, s.parent, {}, 1.0); }},
        {"shown",
         [](PastScene& s) {
             scene::hide(s.builder.world, s.mover);
             scene::show(s.builder.world, s.mover, 0.955);
         }},
    };
    for (const auto& [name, happen] : events) {
        PastScene scene({0, 0, 0});
        Stage stage(device(), scene.builder);
        expectSharp(stage, "before " + name, false);
        happen(scene);
        expectSharp(stage, name, true);
    }
}

TEST_F(HistoryLaw, EntitiesShownOrHiddenDuringTheExposureAreVisibleForTheirShareOfIt) {
    PastScene scene({0, 0, 0});
    scene::World& world = scene.builder.world;
    Stage stage(device(), scene.builder);
    const image::Image there = draw(stage, "sharp");
    scene::hide(world, scene.mover);
    const image::Image without = draw(stage, "sharp");
    scene::show(world, scene.mover, 0.98);
    expectMean(stage, without, 0.25, there);
    EXPECT_TRUE(test::sameBits(draw(stage, "sharp"), there)) << "at the raster instant it is there";
    scene::appear(world, scene.mover, 1.04);
    expectMean(stage, there, 1.0, without);
    // One that stands still.
    PastScene still({0, 0, 0});
    scene::World& stillWorld = still.builder.world;
    stillWorld.registry.remove<scene::LinearVelocity>(still.mover);
    stillWorld.registry.get<scene::LocalTransform>(still.mover).transform.translation.x = 0.0;
    Stage stillStage(device(), still.builder);
    const image::Image standing = draw(stillStage, "sharp");
    for (const auto& [seconds, share] : {std::pair{0.98, 0.25}, {1.04, 1.0}, {0.96, 0.0}}) {
        scene::hide(stillWorld, still.mover, seconds);
        expectMean(stillStage, standing, share, without);
        EXPECT_EQ(test::sameBits(draw(stillStage, "sharp"), without), seconds < 1.0);
    }
}

TEST_F(HistoryLaw, EntitiesThatAppearUnderAMovingCameraHaveTheCamerasBlur) {
    PastScene scene({0, 0.3, 0});
    Stage stage(device(), scene.builder);
    scene::appear(scene.builder.world, scene.mover, 0.95);
    const auto appeared = draw(stage, "accumulate");
    // The same picture as of a mover that never moved.
    const math::dmat4 place = scene::worldFromEntity(scene.builder.world, scene.mover, 1.0);
    scene.builder.world.registry.remove<scene::LinearVelocity>(scene.mover);
    scene.builder.world.registry.get<scene::LocalTransform>(scene.mover).transform.translation =
        math::dvec3(place[3]);
    EXPECT_TRUE(test::sameBits(appeared, draw(stage, "accumulate")));
    expectSharp(stage, "the camera moves", false);
}

constexpr float kWall = 0.2f;
constexpr float kBox = 0.8f;

/// A grey wall and a lighter square of 12 pixels before it, in a picture of 96 x 64. Exposures run
/// from 1 s to 2 s.
struct JumpScene {
    test::SceneBuilder builder;
    ecs::Entity box;

    explicit JumpScene(const math::dvec3& place = {20.0, 8.0, -5.0}) {
        builder.setPixelView(64);
        test::addCard(builder, {400, 400}, math::vec3(kWall), {.position = {0, 0, -9}});
        box = test::addCard(builder, {12, 12}, math::vec3(kBox), {.position = place});
    }

    void animate(
        ecs::Entity entity,
        AnimationPath path,
        Interpolation interpolation,
        std::vector<float> times,
        std::vector<vec4> values
    ) {
        scene::AnimationClip clip;
        clip.duration = double{times.back()};
        clip.channels.push_back({0, path, interpolation, std::move(times), std::move(values)});
        const auto index = static_cast<uint32_t>(builder.world.assets.clips.size());
        builder.world.assets.clips.push_back(std::move(clip));
        builder.world.registry.add(entity, scene::Animated{{{index, 0}}});
    }

    /// Under a parent that is animated.
    void animateParent(
        AnimationPath path,
        Interpolation interpolation,
        std::vector<float> times,
        std::vector<vec4> values
    ) {
        animate(
            test::addParent(builder, box), path, interpolation, std::move(times), std::move(values)
        );
    }
};

Shot shotOf(std::string_view method, scene::ShutterPhase phase = scene::ShutterPhase::End) {
    const bool isStart = phase == scene::ShutterPhase::Start;
    return {
        .method = method,
        .seconds = isStart                             ? 1.0
                   : phase == scene::ShutterPhase::End ? 2.0
                                                       : 1.5,
        .exposureSeconds = 1.0,
        .phase = phase,
        .instants = 64};
}

class JumpLaw : public test::GpuTest {
  protected:
    /// The square's contribution over the wall as a share of its full contribution, at a pixel
    /// relative to the picture's centre, up and right.
    static double shareAt(const image::Image& picture, int x, int y) {
        const auto column = static_cast<uint32_t>(int(picture.width) / 2 + x);
        const auto row = static_cast<uint32_t>(int(picture.height) / 2 - y);
        return (double{picture.at(column, row, 0)} - kWall) / (kBox - kWall);
    }

    /// Largest share beyond the squares around places, and least: of a streak or of a hole.
    static std::pair<double, double>
    findStreak(const image::Image& picture, const std::vector<math::dvec2>& places) {
        double least = 0.0;
        double most = 0.0;
        for (int y = -31; y <= 31; ++y)
            for (int x = -47; x <= 47; ++x) {
                bool isNear = false;
                for (const math::dvec2& place : places)
                    isNear = isNear || (std::abs(x - place.x) < 8 && std::abs(y - place.y) < 8);
                if (isNear)
                    continue;
                least = std::min(least, shareAt(picture, x, y));
                most = std::max(most, shareAt(picture, x, y));
            }
        return {least, most};
    }

    using Shares = std::vector<std::pair<math::dvec2, double>>;

    static void
    expectShares(const image::Image& picture, const Shares& expected, const std::string& what) {
        std::vector<math::dvec2> places;
        for (const auto& [place, share] : expected) {
            EXPECT_NEAR(shareAt(picture, int(place.x), int(place.y)), share, 0.01) << what;
            places.push_back(place);
        }
        const auto [least, most] = findStreak(picture, places);
        EXPECT_GT(least, -0.002) << what;
        EXPECT_LT(most, 0.002) << what;
    }

    /// In every method; by default the filter with rays, lookups, and brute force.
    static void expectSharesInEachMethod(
        const SceneBuilder& scene,
        const Shares& expected,
        const std::function<void(Shot&)>& change = {},
        const std::vector<scene::ShutterPhase>& phases = {scene::ShutterPhase::End}
    ) {
        Stage stage(device(), scene);
        std::vector<std::string_view> methods =
            test::pickMethods(test::listBlurMethods(device()), {"hybrid", "resolved"});
        methods.emplace_back("accumulate");
        for (const std::string_view method : methods)
            for (const scene::ShutterPhase phase : phases) {
                Shot shot = shotOf(method, phase);
                if (change)
                    change(shot);
                const image::Image picture = stage.render(shot).color;
                expectShares(picture, expected, fmt::format("{} {}", method, int(phase)));
            }
    }
};

TEST_F(JumpLaw, AppearingOrVanishingEntitiesCoverTheirPlaceForTheirShareOfTheExposure) {
    for (const float hidden : {0.0f, 1.0e-5f})
        for (const bool appears : {true, false}) {
            SCOPED_TRACE(appears ? "appears" : "vanishes");
            JumpScene scene({16.0, 8.0, 0.0});
            // The square streaks from or to its parent's origin where the jump counts as a way.
            const vec4 before(appears ? hidden : 1.0f);
            const vec4 after(appears ? 1.0f : hidden);
            scene.animateParent(
                AnimationPath::Scale, Interpolation::Step, {0.0f, 1.25f}, {before, after}
            );
            scene.builder.moveCamera({.position = {0, 0, 5}});
            expectSharesInEachMethod(
                scene.builder,
                {{{16, 8}, appears ? 0.75 : 0.25}},
                {},
                {std::begin(test::kPhases), std::end(test::kPhases)}
            );
        }
}

TEST_F(JumpLaw, AStepAtTheFramesOwnTimeHasNotBeenSeenYet) {
    JumpScene scene;
    scene.animate(
        scene.box, AnimationPath::Scale, Interpolation::Step, {0.0f, 2.0f}, {vec4(1.0f), vec4(0.0f)}
    );
    expectSharesInEachMethod(scene.builder, {{{20, 8}, 1.0}}); // at the end of the exposure
    // In the exposure after.
    expectSharesInEachMethod(scene.builder, {}, [](Shot& shot) { shot.seconds = 3.0; });
}

TEST_F(JumpLaw, AJumpingEntityIsNotBlurredBetweenItsPlaces) {
    struct Case {
        const char* what;
        Interpolation interpolation;
        bool loops;
        std::vector<float> times;
        std::vector<float> places;
    };

    const std::vector<Case> cases = {
        {"a key of STEP", Interpolation::Step, false, {0.0f, 1.375f}, {-30, 30}},
        {"two keys at nearly the same time",
         Interpolation::Linear,
         false,
         {0.0f, 1.375f, 1.3752f, 3.0f},
         {-30, -30, 30, 30}},
        {"the end of a loop",
         Interpolation::Linear,
         true,
         {0.0f, 0.374f, 0.375f, 1.375f},
         {30, 30, -30, -30}}};
    for (const Case& each : cases) {
        SCOPED_TRACE(each.what);
        JumpScene scene;
        scene.builder.world.playback.loop = each.loops;
        std::vector<vec4> values;
        for (const float x : each.places)
            values.emplace_back(x, 8.0f, -5.0f, 0.0f);
        scene.animate(
            scene.box, AnimationPath::Translation, each.interpolation, each.times, values
        );
        // The loop is at its second round's jump within the exposure, too.
        const double share = each.loops ? 0.375 + 0.25 : 0.375;
        expectSharesInEachMethod(scene.builder, {{{-30, 8}, share}, {{30, 8}, 1.0 - share}});
    }
}

TEST_F(JumpLaw, TheShuttersResponseWeighsThePlaces) {
    JumpScene scene;
    scene.animate(
        scene.box,
        AnimationPath::Translation,
        Interpolation::Step,
        {0.0f, 1.25f},
        {vec4(-30, 8, -5, 0), vec4(30, 8, -5, 0)}
    );
    expectSharesInEachMethod(scene.builder, {{{-30, 8}, 0.125}, {{30, 8}, 0.875}}, [](Shot& shot) {
        shot.shutter.response.shape = scene::ResponseShape::Triangle;
    });
}

TEST_F(JumpLaw, ACameraThatStepsShowsBothOfItsPictures) {
    JumpScene scene;
    scene.animate(
        scene.builder.camera,
        AnimationPath::Translation,
        Interpolation::Step,
        {0.0f, 1.625f},
        {vec4(0.0f), vec4(40.0f, 0, 0, 0)}
    );
    expectSharesInEachMethod(scene.builder, {{{20, 8}, 0.625}, {{-20, 8}, 0.375}}, [](Shot& shot) {
        shot.shutter.cuts.enabled = false;
    });
}

TEST_F(JumpLaw, ShapesThatStepAreTwoShapes) {
    SceneBuilder builder = test::makePixelView(64);
    test::addCard(builder, {400, 400}, math::vec3(kWall), {.position = {0, 0, -9}});
    scene::Primitive quad = test::makeQuad(12, 12, builder.addColor(math::vec3(kBox)));
    quad.morphTargets.resize(1);
    quad.morphTargets[0].positions.assign(quad.positions.size(), math::vec3(60, 0, 0));
    const ecs::Entity morphed =
        test::addMorphed(builder, quad, {.position = {-30, 8, -5}}, {{0.0f}, {1.0f}, 0.0f, 1.625f});
    for (scene::AnimationClip& clip : builder.world.assets.clips)
        for (scene::WeightChannel& channel : clip.weightChannels)
            channel.interpolation = Interpolation::Step;
    ASSERT_TRUE(builder.world.registry.has<scene::MorphWeights>(morphed));
    expectSharesInEachMethod(builder, {{{-30, 8}, 0.625}, {{30, 8}, 0.375}});
}

/// A textured wall before a turning camera, and a mover that jumps in the middle of its way.
struct JumpInMotion {
    JumpInMotion() {
        mover = scene.add(
            test::makeBox({0.8, 0.8, 0.8}, scene.addWaves()),
            {.position = {0, 0, 0}, .velocity = {4.0, 1.0, 0}}
        );
        const ecs::Entity parent = test::addParent(scene, mover);
        scene::AnimationClip clip;
        clip.duration = 2.0;
        clip.channels.push_back(
            {0,
             AnimationPath::Translation,
             Interpolation::Step,
             {0.0f, float(kSeconds - 0.4 * kExposure), 2.0f},
             {vec4(-5.5f, -1.5f, -3, 0), vec4(-4.0f, -0.5f, -3, 0), vec4(-4.0f, -0.5f, -3, 0)}}
        );
        scene.world.assets.clips.push_back(std::move(clip));
        scene.world.registry.add(parent, scene::Animated{{{0, 0}}});
        scene.moveCamera({.angularVelocity = {0, 0.8, 0}});
    }

    [[nodiscard]] static Shot shotOf(std::string_view method) {
        return {
            .method = method,
            .width = 192,
            .height = 128,
            .seconds = kSeconds,
            .exposureSeconds = kExposure,
            .phase = scene::ShutterPhase::End,
            .frameSeconds = 2.0 * kExposure,
            .instants = 240};
    }

    static constexpr double kSeconds = 1.0;
    static constexpr double kExposure = 1.0 / 48.0;
    SceneBuilder scene = test::makeWavyRoom(5.0, 9.0, 7.0);
    ecs::Entity mover;
};

TEST_F(JumpLaw, AMoverThatJumpsIsBlurredInBothPlacesAndThePictureReportsItsParts) {
    const JumpInMotion jump;
    Stage stage(device(), jump.scene);
    const image::Image truth = stage.render(JumpInMotion::shotOf("accumulate")).color;
    const auto frame = stage.render(JumpInMotion::shotOf("resolved"));
    EXPECT_GT(image::computePsnr(frame.color, truth), 38.0);
    for (const std::string_view method : {"gather", "guertin2014", "jimenez2014", "mcguire2012"})
        EXPECT_GT(image::computePsnr(stage.render(JumpInMotion::shotOf(method)).color, truth), 28.0)
            << method;
    EXPECT_EQ(frame.statistics.counters.at("exposure parts"), 2u);
    EXPECT_TRUE(render::findDecision(frame.statistics.explanations, "exposure parts") != nullptr);
    Shot before = JumpInMotion::shotOf("resolved");
    before.seconds -= 0.5 * JumpInMotion::kExposure;
    EXPECT_FALSE(stage.render(before).statistics.counters.contains("exposure parts"));
}

} // namespace
} // namespace shutter
