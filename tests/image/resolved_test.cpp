// SPDX-License-Identifier: MIT
// Looked-up samples: near the truth if a raster holds them; blocks of one plane, crowded tiles, and
// the raster of the exposure's other end; valid and invalid history, by pictures drawn in sequence
// with events in between. A frame gets the same history whether the previous frame stored it or it
// is drawn again.
#include "engine/image/metrics.h"
#include "engine/scene/history.h"
#include "engine/scene/lens.h"
#include "engine/scene/path.h"
#include "tests/image/laws.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/picture.h"
#include "tests/support/stage.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

namespace shutter {
namespace {

using math::dvec3;
using test::AdaptiveLaw;

/// 192x128 pixels, 1/48 s that end with the frame.
test::Shot shotOf(std::string_view method) {
    test::Shot shot{
        .method = method,
        .width = 192,
        .height = 128,
        .exposureSeconds = 1.0 / 48.0,
        .phase = scene::ShutterPhase::End};
    shot.settings.raysPerPixel = 0.0f;
    return shot;
}

class Resolved : public test::GpuTest {
  protected:
    /// A textured wall, a post before it and a box that passes between them.
    static test::SceneBuilder makeScene(const test::Placement& camera = {}) {
        test::SceneBuilder scene = test::makeView();
        scene.moveCamera(camera);
        const scene::AssetIndex waves = scene.addTextured(scene.addWaveTexture(), true);
        scene.add(test::makeQuad(8, 6, waves), {.position = {0, 0, -5}});
        scene.add(test::makeBox({0.15, 3, 0.1}, waves), {.position = {0.4, 0, -2}});
        scene.add(
            test::makeBox({0.8, 0.6, 0.5}, scene.addWaves()),
            {.position = {-0.3, 0, -3}, .velocity = {12.0, 2.0, 0.0}}
        );
        return scene;
    }

    /// A camera that turns about a fence of narrow bars, so that the background moves past them.
    static test::SceneBuilder makeFence(bool hasWall) {
        test::SceneBuilder scene = test::makeView(0.785);
        scene.moveCamera(
            {.position = {0, 0, 4},
             .velocity = {10.0, 0.0, 0.0},
             .angularVelocity = {0.0, 1.0, 0.0}}
        );
        const scene::AssetIndex green = scene.addColor({0.0f, 1.0f, 0.0f});
        const scene::AssetIndex bar = scene.addMesh({test::makeQuad(0.25, 20, green)});
        for (int i = -14; i <= 14; ++i)
            scene.add(bar, {.position = {i * 0.5, 0, -6}});
        if (hasWall)
            test::addCard(scene, {200, 200}, {0.1f, 0.1f, 0.6f}, {.position = {0, 0, -30}});
        return scene;
    }

    static test::Shot fenceShotOf(std::string_view method) {
        test::Shot shot = shotOf(method);
        shot.width = 320;
        shot.height = 180;
        shot.exposureSeconds = 1.0 / 60.0;
        shot.phase = scene::ShutterPhase::Centre;
        return shot;
    }

    /// The gather with the paper's numbers: how hard a shot is.
    static test::Shot paperGather() {
        test::Shot shot = shotOf("gather");
        shot.settings = motion_blur::paperSettings();
        return shot;
    }

    /// `resolved` is near the truth, and the shot is hard.
    static void expectNearTruth(const test::SceneBuilder& scene, double least, double mostByPaper) {
        test::Comparison shot(device(), scene, shotOf("sharp"), 15);
        EXPECT_GT(shot.psnr("resolved"), least);
        EXPECT_LT(shot.psnr(paperGather()), mostByPaper) << "the shot is hard";
    }
};

TEST_F(Resolved, AMoverBetweenAPostAndAWallIsNearTheTruthWhateverTheCameraDoes) {
    expectNearTruth(makeScene(), 38.0, 32.0);
    expectNearTruth(
        makeScene({.velocity = {1.0, 0.3, -2.0}, .angularVelocity = {0.2, 1.5, 0.6}}), 32.0, 31.0
    );
}

TEST_F(Resolved, BarsThatHideABackgroundAreNoWiderAndItHasItsOwnColour) {
    for (const bool hasWall : {false, true}) {
        const test::SceneBuilder scene = makeFence(hasWall);
        test::Comparison fence(device(), scene, fenceShotOf("sharp"), 64);
        const auto frame = fence.render("resolved");
        test::Shot alone = fenceShotOf("resolved");
        alone.settings.history = false;
        const double resolvedAlone = fence.psnr(alone);
        for (const std::string_view method : {"sharp", "own_velocity", "gather", "guertin2014"}) {
            const double other = fence.psnr(method);
            EXPECT_GT(fence.psnr(frame), other) << method << ", wall " << hasWall;
            EXPECT_TRUE(method != "gather" || resolvedAlone > other) << "wall " << hasWall;
        }
        if (hasWall)
            continue;
        // Each raster knows an edge to half a pixel. What any of them shows must not count as
        // there: movers would be too wide, and the picture would have too much of their colour.
        EXPECT_NEAR(
            test::sumChannel(frame.color, 1) / test::sumChannel(fence.truth(), 1), 1.0, 0.01
        );
    }
}

/// Rails before a wall, as entities of their own or merged into one mesh.
struct Rails {
    bool areOneMesh = false;
    test::Placement level{}; ///< of all of it
    test::Placement camera{};
    double railsAt = -3.0;
    double wallAt = -12.0;

    [[nodiscard]] test::SceneBuilder make() const {
        test::SceneBuilder scene = test::makeView(0.87);
        scene.moveCamera(camera);
        std::vector<scene::Primitive> rails;
        const scene::AssetIndex waves = scene.addWaves();
        const scene::AssetIndex colors[] = {
            scene.addColor({0.0f, 1.0f, 0.0f}), scene.addColor({0.9f, 0.2f, 0.1f})};
        for (int i = -12; i <= 12; ++i)
            rails.push_back(test::transformed(
                test::makeQuad(0.12, 6.0, colors[i & 1]),
                glm::translate(math::dmat4(1.0), dvec3(i * 0.5, 0, railsAt))
            ));
        scene::Primitive wall = test::transformed(
            test::makeQuad(40, 20, waves), glm::translate(math::dmat4(1.0), dvec3(0, 0, wallAt))
        );
        if (areOneMesh) {
            rails.push_back(std::move(wall));
        } else {
            scene.add(std::move(wall), level);
        }
        scene.add(scene.addMesh(std::move(rails)), level);
        return scene;
    }

    /// dB of `method` against 64 instants, apart and as one mesh.
    [[nodiscard]] static std::pair<double, double>
    psnr(gpu::Device& device, Rails rails, const test::Shot& shot) {
        rails.areOneMesh = false;
        const double apart = test::Comparison(device, rails.make(), shot, 64).psnr(shot);
        rails.areOneMesh = true;
        return {apart, test::Comparison(device, rails.make(), shot, 64).psnr(shot)};
    }
};

TEST_F(Resolved, HowALevelIsCutIntoMeshesDoesNotDecideHowItBlurs) {
    test::Shot shot = fenceShotOf("resolved");
    shot.exposureSeconds = 0.02;
    const Rails slides{.camera = {.velocity = {6, 0, 0}}};
    const Rails rolls{.camera = {.velocity = {6, 0, 0}, .angularVelocity = {0, 0, 2}}};
    const Rails approaches{.camera = {.position = {0.2, 0, 0}, .velocity = {0, 0, -6}}};
    const Rails turns{
        .level = {.position = {0, 0, -6}, .angularVelocity = {0, 2, 0}},
        .railsAt = 1.5,
        .wallAt = -1.5};
    for (const Rails& rails : {slides, rolls, approaches, turns}) {
        for (const bool history : {true, false}) {
            shot.settings.history = history;
            const auto [apart, oneMesh] = Rails::psnr(device(), rails, shot);
            EXPECT_GT(oneMesh, apart - 0.6) << "history " << history;
        }
        shot.settings.history = true;
    }
    shot.settings.secondRaster = true;
    const auto [apart, oneMesh] = Rails::psnr(device(), slides, shot);
    EXPECT_GT(oneMesh, apart - 0.6);
}

TEST_F(Resolved, AWallBehindRailsOfItsOwnMeshIsAsFarOutOfFocusAsOneBehindOthers) {
    test::Shot shot = fenceShotOf("resolved");
    for (const double focus : {3.0, 12.0}) {
        const auto psnr = [&](bool isOneMesh) {
            test::SceneBuilder scene =
                Rails{.areOneMesh = isOneMesh, .camera = {.velocity = {0.02, 0, 0}}}.make();
            const scene::CameraLens lens{.fStop = 0.25, .focusDistance = focus};
            scene.world.registry.add(scene.camera, lens);
            return test::Comparison(device(), scene, shot, 256).psnr(shot);
        };
        EXPECT_GT(psnr(true), std::min(psnr(false), 50.0) - 0.6) << "focus " << focus;
    }
}

TEST_F(Resolved, SurfacesThatCrossTheCamerasPlaneAreNearTheTruth) {
    test::SceneBuilder scene = test::makeView(1.4);
    scene.moveCamera({.velocity = {4.0, 0.0, -60.0}});
    const scene::AssetIndex waves = scene.addWaves();
    // Floor, ceiling and wall begin behind the camera and end far ahead: tiles at the picture's
    // border have depths down to 0 at some instant.
    scene.add(test::makeBox({60, 0.1, 60}, waves), {.position = {0, -0.5, 0}});
    scene.add(test::makeBox({60, 0.1, 60}, waves), {.position = {0, 1.5, 0}});
    scene.add(test::makeBox({0.1, 8, 60}, waves), {.position = {2.0, 0, 0}});
    expectNearTruth(scene, 36.0, 24.0);
}

TEST_F(Resolved, TheLastFrameHoldsWhatThisOneHides) {
    const test::SceneBuilder scene = makeScene();
    test::Shot without = shotOf("resolved");
    without.settings.history = false;
    const auto alone = test::renderOnce(device(), scene, without);
    const auto both = test::renderOnce(device(), scene, shotOf("resolved"));
    EXPECT_EQ(alone.statistics.counters.at("history bytes"), 0u);
    EXPECT_EQ(alone.statistics.counters.at("samples from the last frame"), 0u);
    EXPECT_GT(both.statistics.counters.at("samples from the last frame"), 0u);
    // Two rasters in turns, each of a half-float colour and two floats per pixel.
    EXPECT_EQ(both.statistics.counters.at("history bytes"), 2u * 192u * 128u * 16u);
    EXPECT_LT(
        both.statistics.counters.at("unresolved samples"),
        alone.statistics.counters.at("unresolved samples") / 4
    );
}

TEST_F(Resolved, OnlyTilesThatSeeMoreEntitiesThanAListHoldsAreCrowded) {
    test::SceneBuilder scene = test::makePixelView(64);
    const scene::AssetIndex color = scene.addColor(math::vec3(1.0f));
    const scene::AssetIndex mesh = scene.addMesh({test::makeQuad(1, 1, color)});
    // One per pixel of a block of 8 x 8: twice as many as a tile has room for.
    for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 8; ++x)
            scene.add(mesh, {.position = {x + 0.5, y + 0.5, -10}, .velocity = {0, 48.0 * 3, 0}});
    test::Shot shot = shotOf("resolved");
    shot.width = shot.height = 64;
    const auto drawn = test::renderOnce(device(), scene, shot);
    EXPECT_GT(drawn.statistics.counters.at("crowded tiles"), 0u);
    EXPECT_TRUE(test::allFinite(drawn.color));
    const auto small = test::renderOnce(device(), makeScene(), shotOf("resolved"));
    EXPECT_EQ(small.statistics.counters.at("crowded tiles"), 0u);
}

/// Each pixel searches for itself.
test::Shot searchedShot() {
    test::Shot shot = shotOf("resolved");
    shot.settings.uniformMotionPx = 0.0f;
    return shot;
}

/// A wall and posts at three depths before it.
test::SceneBuilder makePosts(const test::Placement& camera) {
    test::SceneBuilder scene = test::makeView();
    scene.moveCamera(camera);
    const scene::AssetIndex waves = scene.addTextured(scene.addWaveTexture(), true);
    scene.add(test::makeQuad(16, 12, waves), {.position = {0, 0, -6}});
    for (const double x : {-1.2, 0.1, 1.0})
        scene.add(test::makeBox({0.1, 3, 0.1}, waves), {.position = {x, 0, -3.0 + x}});
    return scene;
}

struct Both {
    render::FrameResult together;
    render::FrameResult each;
    double truthOfTogether = 0.0; ///< PSNR against the truth, dB
    double truthOfEach = 0.0;
};

Both drawBoth(const test::SceneBuilder& scene) {
    test::Comparison shot(test::sharedDevice(), scene, shotOf("sharp"), 64);
    Both both{
        shot.render("resolved"), test::renderOnce(test::sharedDevice(), scene, searchedShot())};
    both.truthOfTogether = shot.psnr(both.together);
    both.truthOfEach = shot.psnr(both.each);
    return both;
}

uint64_t countUniform(const render::FrameResult& drawn) {
    return drawn.statistics.counters.at("blocks uniform");
}

TEST_F(Resolved, ACameraThatTurnsSeesPlanesNearlyEverywhere) {
    const test::SceneBuilder scene = makePosts({.angularVelocity = {0.3, 2.0, 0.0}});
    const Both both = drawBoth(scene);
    constexpr uint64_t kBlocks = 192 * 128 / 64;
    EXPECT_GT(countUniform(both.together), kBlocks / 2);
    EXPECT_EQ(countUniform(both.each), 0u);
    EXPECT_GT(both.truthOfTogether, both.truthOfEach - 0.3);
    test::Shot beyond = shotOf("resolved");
    beyond.settings.sampleCount = 33; // more than blocks store: searched per pixel
    EXPECT_EQ(countUniform(test::renderOnce(device(), scene, beyond)), 0u);
    // Two pixels in all: five instants instead of 15 miss no texel.
    const Both slow = drawBoth(makePosts({.angularVelocity = {0.0, 0.5, 0.0}}));
    EXPECT_GT(countUniform(slow.together), 0u);
    EXPECT_GT(slow.truthOfTogether, slow.truthOfEach - 0.3);
}

TEST_F(Resolved, PostsThatParallaxMovesAreNoPlaneWithTheWall) {
    const Both both = drawBoth(makePosts({.velocity = {6.0, 0.0, -3.0}}));
    EXPECT_GT(countUniform(both.together), 0u);
    EXPECT_GT(both.truthOfTogether, both.truthOfEach - 0.3);
    // Along the posts' edges, too: the largest difference between the two is one of interpolation.
    EXPECT_LT(image::computeMaxDifference(both.together.color, both.each.color), 0.25);
}

TEST_F(Resolved, StaticSurfacesInFrontOfAMoverAreNotPaintedOver) {
    test::SceneBuilder scene = test::makeView();
    const scene::AssetIndex waves = scene.addTextured(scene.addWaveTexture(), true);
    // Fills the picture at every instant.
    scene.add(
        test::makeQuad(40, 16, waves), {.position = {0, 0, -5}, .velocity = {60.0, 0.0, 0.0}}
    );
    const scene::AssetIndex red = scene.addColor(math::vec3(1.0f, 0.0f, 0.0f));
    scene.add(test::makeBox({0.15, 3, 0.1}, red), {.position = {0.05, 0, -2}});
    const auto drawn = test::renderOnce(device(), scene, shotOf("resolved"));
    const auto sharp = test::renderOnce(device(), scene, shotOf("sharp"));
    EXPECT_GT(countUniform(drawn), 0u);
    const auto isPost = [&](uint32_t x, uint32_t y) {
        const math::vec3 color(
            sharp.color.at(x, y, 0), sharp.color.at(x, y, 1), sharp.color.at(x, y, 2)
        );
        return color.r > 0.0f && color.g == 0.0f && color.b == 0.0f;
    };
    EXPECT_EQ(test::computeMaxDifferenceWhere(drawn.color, sharp.color, isPost), 0.0);
}

TEST_F(Resolved, OrthographicCamerasSeePlanesToo) {
    test::SceneBuilder scene = test::makePixelView(128);
    const scene::AssetIndex waves = scene.addTextured(scene.addWaveTexture(), true);
    scene.add(
        test::makeQuad(384, 256, waves), {.position = {0, 0, -10}, .velocity = {600.0, 200.0, 0.0}}
    );
    const auto drawn = test::renderOnce(device(), scene, shotOf("resolved"));
    EXPECT_GT(countUniform(drawn), 0u);
    const auto each = test::renderOnce(device(), scene, searchedShot());
    EXPECT_GT(image::computePsnr(drawn.color, each.color), 45.0);
}

constexpr uint32_t kCrowdWidth = 96;
constexpr uint32_t kCrowdHeight = 64;
constexpr uint64_t kCrowdTiles = (kCrowdWidth / 16) * (kCrowdHeight / 16);

test::Shot crowdShotOf(std::string_view method) {
    test::Shot shot{
        .method = method,
        .width = kCrowdWidth,
        .height = kCrowdHeight,
        .exposureSeconds = 1.0 / 48.0,
        .phase = scene::ShutterPhase::End,
        .frameSeconds = 1.0 / 24.0};
    shot.settings.sampleCount = 0; // the method's own
    return shot;
}

/// 1500 squares of 3.5 pixels before a wall.
struct Crowd {
    dvec3 together{0.0};      ///< m/s, of all
    double apart = 0.0;       ///< m/s at most, each in another direction
    test::Placement camera{}; ///< of the picture
};

test::SceneBuilder makeCrowd(const Crowd& crowd) {
    const dvec3 kFrom(-3.2, -2.2, -5.5);
    const dvec3 kSize(6.4, 4.4, 2.0);
    test::SceneBuilder scene = test::makeView();
    scene.moveCamera(crowd.camera);
    scene.add(
        test::makeQuad(16, 12, scene.addTextured(scene.addWaveTexture(), true)),
        {.position = {0, 0, -6}}
    );
    // A pixel at the depth of -4.5 m.
    const double side = 3.5 * 4.5 * 2.0 * std::tan(0.45) / kCrowdHeight;
    std::mt19937 random(3);
    const auto unit = [&] { return double(random()) / double(std::mt19937::max()); };
    std::vector<scene::AssetIndex> meshes;
    for (int i = 0; i < 8; ++i) {
        const double red = unit();
        const double green = unit();
        const double blue = unit();
        meshes.push_back(scene.addMesh(
            {test::makeQuad(side, side, scene.addColor(math::vec3(red, green, blue)))}
        ));
    }
    for (int i = 0; i < 1500; ++i) {
        test::Placement one;
        for (int axis = 0; axis < 3; ++axis)
            one.position[axis] = kFrom[axis] + unit() * kSize[axis];
        const double angle = unit() * 2.0 * 3.14159265358979;
        const double speed = crowd.apart * std::sqrt(unit());
        one.velocity = crowd.together + speed * dvec3(std::cos(angle), std::sin(angle), 0.0);
        scene.add(meshes[size_t(i) % meshes.size()], one);
    }
    return scene;
}

TEST_F(Resolved, CrowdsAreNearerToTheTruthThanFiltersUnderAnyMotion) {
    for (const Crowd& crowd :
         {Crowd{.together = {8.0, 2.0, 0.0}},
          Crowd{.apart = 10.0},
          Crowd{.camera = {.angularVelocity = {0.2, 1.5, 0.3}}},
          Crowd{.camera = {.velocity = {8.0, 0.0, -8.0}}}}) {
        const test::SceneBuilder scene = makeCrowd(crowd);
        test::Comparison shot(device(), scene, crowdShotOf("sharp"), 64);
        const auto drawn = shot.render("resolved");
        EXPECT_GT(drawn.statistics.counters.at("crowded tiles"), kCrowdTiles / 2);
        for (const char* filter : {"own_velocity", "gather"})
            EXPECT_GT(shot.psnr(drawn), shot.psnr(filter) + 1.0) << filter;
    }
}

/// A textured wall, two posts in front of it and two boxes that cross between them: surfaces
/// that one hides at the exposure's end, and hid a frame before, are visible at its beginning.
test::SceneBuilder makeCrossedBoxes() {
    test::SceneBuilder scene = test::makeView();
    const scene::AssetIndex waves = scene.addTextured(scene.addWaveTexture(), true);
    scene.add(test::makeQuad(8, 6, waves), {.position = {0, 0, -5}});
    scene.add(
        test::makeBox({0.8, 0.6, 0.5}, scene.addWaves()),
        {.position = {-0.3, 0, -3}, .velocity = {12.0, 2.0, 0.0}}
    );
    scene.add(
        test::makeBox({1.2, 0.2, 0.2}, scene.addWaves()),
        {.position = {0.2, 0.1, -2.5}, .angularVelocity = {0, 0, 60}}
    );
    return scene;
}

test::Shot secondShot(std::string_view method) {
    test::Shot shot = shotOf(method);
    shot.frameSeconds = 1.0 / 24.0;
    shot.settings.secondRaster = true;
    return shot;
}

bool drawsSecond(const render::FrameResult& frame) {
    return test::hasPass(frame, "second G-buffer");
}

TEST_F(Resolved, TheSecondRasterShowsSurfacesHiddenInTheOthers) {
    const test::SceneBuilder scene = makeCrossedBoxes();
    test::Comparison shot(device(), scene, shotOf("sharp"), 15);
    const auto without = shot.render("resolved");
    const auto with = test::renderOnce(device(), scene, secondShot("resolved"));
    EXPECT_FALSE(drawsSecond(without));
    EXPECT_TRUE(drawsSecond(with));
    EXPECT_EQ(without.statistics.counters.at("samples from the second raster"), 0u);
    EXPECT_GT(with.statistics.counters.at("samples from the second raster"), 0u);
    EXPECT_LT(
        with.statistics.counters.at("unresolved samples"),
        without.statistics.counters.at("unresolved samples") / 2
    );
    EXPECT_GT(shot.psnr(with), shot.psnr(without) + 1.0);
}

TEST_F(Resolved, TheSecondRasterIsAtTheOppositeEndOfTheExposure) {
    const test::SceneBuilder scene = makeCrossedBoxes();
    for (const auto phase : {scene::ShutterPhase::End, scene::ShutterPhase::Start}) {
        test::Shot shot = secondShot("resolved");
        shot.phase = phase;
        shot.aovs = {"second"};
        const auto drawn = test::renderOnce(device(), scene, shot);
        test::Shot sharp = shotOf("sharp");
        sharp.phase = phase;
        sharp.instant = phase == scene::ShutterPhase::End ? 0.0 : 1.0;
        const auto expected = test::renderOnce(device(), scene, sharp);
        EXPECT_TRUE(test::sameBits(drawn.intermediates.at("second"), expected.color));
    }
}

TEST_F(AdaptiveLaw, PicturesWithoutRaysHaveTheBitsOfResolvedUnderEverySetting) {
    const test::SceneBuilder scene = makeCrossedBoxes();
    for (const char* setting : {"second raster", "noise", "anti-aliasing"}) {
        const auto draw = [&](std::string_view method) {
            test::Shot shot = shotOf(method);
            shot.frameSeconds = 1.0 / 24.0;
            const std::string_view name = setting;
            shot.settings.secondRaster = name == "second raster";
            if (name == "noise")
                shot.settings.instantNoise = motion_blur::InstantNoise::Fixed;
            return test::Frames(device(), scene)
                .draw(
                    shot,
                    [&](game::PictureRequest& request) {
                        if (name == "anti-aliasing")
                            request.antiAliasing = game::AntiAliasing::Taa;
                        request.drawsFramesBefore = true;
                    }
                )
                .color;
        };
        EXPECT_TRUE(test::sameBits(draw("adaptive"), draw("resolved"))) << setting;
    }
}

TEST_F(Resolved, StaticFramesAndFiltersDrawNoSecondRaster) {
    test::SceneBuilder scene = test::makeWavyRoom(5.0, 8.0, 6.0);
    EXPECT_FALSE(drawsSecond(test::renderOnce(device(), scene, secondShot("resolved"))));
    EXPECT_FALSE(drawsSecond(test::renderOnce(device(), makeCrossedBoxes(), secondShot("gather"))));
}

constexpr double kFramesPerSecond = 48.0;
constexpr double kExposureSeconds = 0.5 / kFramesPerSecond;

/// A textured wall and a red box that crosses the picture's upper half in front of it.
struct Scene {
    test::SceneBuilder builder;
    ecs::Entity box;

    /// \param isGrey the wall is of one grey
    explicit Scene(bool isGrey = false) {
        builder.setPerspective(0.9);
        builder.add(
            test::makeQuad(8, 6, isGrey ? builder.addColor(math::vec3(0.3f)) : builder.addWaves()),
            {.position = {0, 0, -5}}
        );
        box = test::addBox(
            builder,
            {0.6, 0.6, 0.5},
            {1.0f, 0.0f, 0.0f},
            {.position = {-0.3, 0.6, -3}, .velocity = {24.0, 0.0, 0.0}}
        );
    }

    [[nodiscard]] scene::World& world() { return builder.world; }
};

struct FrameOptions {
    std::string_view method = "resolved";
    bool history = true;
    uint32_t width = 192;
    uint32_t height = 128;
    ecs::Entity camera; ///< null: the scene's
    double exposureSeconds = kExposureSeconds;
};

/// Draws frames of a scene in any order, as an application does.
class HistoryFrames : public test::Frames {
  public:
    HistoryFrames(gpu::Device& device, const Scene& scene) : Frames(device, scene.builder) {}

    render::FrameResult at(int frame, const FrameOptions& options = {}) {
        test::Shot shot{
            .method = options.method,
            .width = options.width,
            .height = options.height,
            .seconds = frame / kFramesPerSecond,
            .exposureSeconds = options.exposureSeconds,
            .phase = scene::ShutterPhase::End,
            .frameSeconds = 1.0 / kFramesPerSecond};
        shot.settings.history = options.history;
        return draw(shot, [&](game::PictureRequest& request) {
            if (options.camera != ecs::Entity{})
                request.frame.view.camera = options.camera;
        });
    }
};

/// 0 where nothing moves.
uint64_t countFromLast(const render::FrameResult& frame) {
    const auto& counters = frame.statistics.counters;
    const auto found = counters.find("samples from the last frame");
    return found == counters.end() ? 0 : found->second;
}

/// The raster of the previous frame was drawn once more.
bool drawsLast(const render::FrameResult& frame) {
    return test::hasPass(frame, "last G-buffer");
}

/// The frame as it is after one that kept its raster.
render::FrameResult drawFollowing(Scene& scene, FrameOptions options = {}, int frame = 0) {
    HistoryFrames frames(test::sharedDevice(), scene);
    (void)frames.at(frame - 1, options);
    auto drawn = frames.at(frame, options);
    EXPECT_FALSE(drawsLast(drawn));
    EXPECT_GT(countFromLast(drawn), 0u);
    return drawn;
}

/// The frame as it is drawn without the one before.
render::FrameResult drawAlone(Scene& scene, FrameOptions options = {}, int frame = 0) {
    options.history = false;
    return HistoryFrames(test::sharedDevice(), scene).at(frame, options);
}

TEST_F(Resolved, FramesBeforeACutAreNotLookedUp) {
    Scene scene;
    HistoryFrames frames(device(), scene);
    (void)frames.at(-1);
    // The frame of the cut is sharp; the one after it moves, and must not see past the cut.
    scene::cut(scene.world(), scene.builder.camera, -0.75 / kFramesPerSecond);
    const auto ofCut = frames.at(0);
    EXPECT_EQ(countFromLast(ofCut), 0u);
    EXPECT_TRUE(test::sameBits(ofCut.color, drawAlone(scene).color));
    EXPECT_TRUE(test::sameBits(frames.at(1).color, HistoryFrames(device(), scene).at(1).color));
}

TEST_F(Resolved, FramesOfAnotherCameraAreNotLookedUp) {
    Scene scene;
    const ecs::Entity other = scene.world().registry.create();
    scene.world().registry.add(other, scene::LocalTransform{{.translation = {0.3, 0, 0.5}}});
    scene.world().registry.add(other, scene.builder.cameraSettings());
    scene.world().cameras.push_back(other);
    HistoryFrames frames(device(), scene);
    for (int frame = -2; frame < 0; ++frame) {
        (void)frames.at(frame);
        (void)frames.at(frame, {.camera = other});
    }
    EXPECT_TRUE(test::sameBits(frames.at(0).color, drawFollowing(scene).color));
    EXPECT_TRUE(test::sameBits(
        frames.at(0, {.camera = other}).color, drawFollowing(scene, {.camera = other}).color
    ));
}

TEST_F(Resolved, AFrameAfterAnotherMethodFindsTheSameHistory) {
    const FrameOptions small = {.width = 96, .height = 64};

    struct Before {
        std::string what;
        int frame;
        FrameOptions options;
        FrameOptions own;
    };

    const std::vector<Before> cases = {
        {"after another size", -1, {}, small},
        {"after a gap", -3, {}, {}},
        {"after another method", -1, {.method = "gather"}, {}},
        {"after a sharp frame", -1, {.exposureSeconds = 0.0}, {}},
        {"after one without history", -1, {.history = false}, {}}};
    for (const auto& [what, before, options, own] : cases) {
        Scene scene;
        HistoryFrames frames(device(), scene);
        (void)frames.at(-9, own); // whose history is outdated
        (void)frames.at(before, options);
        const auto drawn = frames.at(0, own);
        EXPECT_TRUE(drawsLast(drawn)) << what;
        EXPECT_TRUE(test::sameBits(drawn.color, drawFollowing(scene, own).color)) << what;
        EXPECT_FALSE(drawsLast(frames.at(1, own))) << what << ": this one kept its own";
    }
    Scene scene;
    const auto first = HistoryFrames(device(), scene).at(0);
    EXPECT_TRUE(drawsLast(first));
    EXPECT_TRUE(test::sameBits(first.color, drawFollowing(scene).color)) << "the first frame";
}

/// It keeps rasters too.
TEST_F(AdaptiveLaw, AFrameByResolvedAfterwardsFindsTheSameHistory) {
    Scene scene;
    HistoryFrames frames(device(), scene);
    (void)frames.at(-9); // whose history is outdated
    (void)frames.at(-1, {.method = "adaptive"});
    EXPECT_TRUE(test::sameBits(frames.at(0).color, drawFollowing(scene).color));
}

TEST_F(Resolved, AFrameFromWhichOnTheLensSpreadsFindsTheSameHistory) {
    // The wall is static in the raster of the frame before, whose lens left all in focus.
    Scene scene;
    scene.world().registry.add(
        scene.builder.camera,
        scene::FocusMotion{
            {{-0.6 / kFramesPerSecond, 5.0, 1e6}, {-0.55 / kFramesPerSecond, 5.0, 0.02}}}
    );
    HistoryFrames frames(device(), scene);
    EXPECT_FALSE(test::hasPass(frames.at(-1), "filter lens"));
    const auto following = frames.at(0);
    EXPECT_TRUE(test::hasPass(following, "filter lens"));
    EXPECT_GT(countFromLast(following), 0u);
    const auto alone = HistoryFrames(device(), scene).at(0);
    EXPECT_TRUE(drawsLast(alone));
    EXPECT_TRUE(test::sameBits(alone.color, following.color));
}

TEST_F(Resolved, ThePreviousFrameIsLookedUpAndFoundAgainByAFrameThatIsDrawnAgain) {
    Scene scene;
    HistoryFrames frames(device(), scene);
    (void)frames.at(-1);
    const auto first = frames.at(0);
    EXPECT_GT(countFromLast(first), 0u);
    EXPECT_FALSE(test::sameBits(first.color, drawAlone(scene).color));
    // As while time is paused: nothing is drawn for it, however long.
    for (int i = 0; i < 3; ++i) {
        const auto again = frames.at(0);
        EXPECT_FALSE(drawsLast(again)) << i;
        EXPECT_TRUE(test::sameBits(again.color, first.color)) << i;
    }
    const auto resumed = frames.at(1);
    EXPECT_FALSE(drawsLast(resumed));
    EXPECT_TRUE(test::sameBits(resumed.color, drawFollowing(scene, {}, 1).color));
}

TEST_F(Resolved, NoHistoryIsDrawnIfNoneIsLookedUp) {
    Scene scene;
    HistoryFrames frames(device(), scene);
    EXPECT_FALSE(drawsLast(frames.at(0, {.exposureSeconds = 0.0})));
    EXPECT_FALSE(drawsLast(frames.at(1, {.method = "gather"})));
    EXPECT_FALSE(drawsLast(frames.at(2, {.history = false})));
    scene::cut(scene.world(), scene.builder.camera, 2.5 / kFramesPerSecond);
    EXPECT_FALSE(drawsLast(frames.at(3))) << "nothing moves in the frame of a cut";
    const auto afterCut = frames.at(4);
    EXPECT_TRUE(drawsLast(afterCut)) << "the frame of the cut is history of the one after it";
    EXPECT_GT(countFromLast(afterCut), 0u);
    scene.world().registry.remove<scene::LinearVelocity>(scene.box);
    const auto still = frames.at(5);
    EXPECT_FALSE(drawsLast(still));
    EXPECT_FALSE(test::hasPass(still, "pack surface") || test::hasPass(still, "keep colour"));
}

TEST_F(Resolved, TheFirstFrameThatMovesIsAsNearToTheTruthAsTheNext) {
    Scene scene;
    // It is static until the shutter opens for frame 0.
    scene::PathMotion path;
    path.interpolation = scene::PathInterpolation::Linear;
    path.keys.resize(3);
    for (const auto& [key, seconds, x] :
         {std::tuple{0, -1.0, -0.3}, {1, -kExposureSeconds, -0.3}, {2, 1.0, 24.0}}) {
        path.keys[key].seconds = seconds;
        path.keys[key].position = {x, 0.6, -3};
    }
    scene.world().registry.remove<scene::LinearVelocity>(scene.box);
    scene.world().registry.add(scene.box, path);
    HistoryFrames frames(device(), scene);
    for (int frame = -3; frame < 0; ++frame)
        EXPECT_FALSE(test::hasPass(frames.at(frame), "resolve")) << frame;
    const auto drawn = frames.at(0);
    test::Shot truth{
        .method = "accumulate",
        .width = 192,
        .height = 128,
        .exposureSeconds = kExposureSeconds,
        .phase = scene::ShutterPhase::End,
        .frameSeconds = 1.0 / kFramesPerSecond,
        .instants = 15};
    const auto expected = test::renderOnce(device(), scene.builder, truth);
    EXPECT_GT(countFromLast(drawn), 0u);
    EXPECT_GT(
        image::computePsnr(drawn.color, expected.color),
        image::computePsnr(drawAlone(scene).color, expected.color) + 3.0
    );
}

TEST_F(Resolved, UnusedHistoryIsFreedAfterAWhile) {
    Scene scene;
    HistoryFrames frames(device(), scene);
    (void)frames.at(0, {.method = "gather"});
    (void)frames.at(1, {.method = "gather"});
    device().collect();
    const uint32_t without = device().living().images;
    (void)frames.at(2);
    (void)frames.at(3);
    for (uint32_t i = 0; i <= core::kFramesKept; ++i)
        (void)frames.at(int(i % 2), {.method = "gather"}); // in which the box is in the picture
    device().collect();
    EXPECT_EQ(device().living().images, without);
}

/// What red exceeds green by at most: where the red box or a ghost of it is.
float findReddest(const image::Image& picture) {
    float most = 0.0f;
    for (uint32_t y = 0; y < picture.height; ++y)
        for (uint32_t x = 0; x < picture.width; ++x)
            most = std::max(most, picture.at(x, y, 0) - picture.at(x, y, 1));
    return most;
}

TEST_F(Resolved, RemovedEntitiesLeaveNoGhost) {
    const auto teleportAway = [](Scene& scene) {
        scene::teleport(
            scene.world(), scene.box, {.translation = {0, 0, 50}}, -0.75 / kFramesPerSecond
        );
    };
    const auto hide = [](Scene& scene) { scene::hide(scene.world(), scene.box); };
    const auto despawn = [](Scene& scene) { scene::despawn(scene.world(), scene.box); };
    const std::vector<std::pair<std::string, std::function<void(Scene&)>>> events = {
        {"teleported", teleportAway}, {"hidden", hide}, {"despawned", despawn}};
    for (const auto& [name, happen] : events) {
        Scene scene(true);
        // The camera turns, so that every pixel is searched for.
        scene.builder.moveCamera({.angularVelocity = {0.0, 3.0, 0.0}});
        HistoryFrames frames(device(), scene);
        EXPECT_GT(findReddest(frames.at(-1).color), 0.5f) << "the box is in the picture";
        happen(scene);
        const auto drawn = frames.at(0);
        EXPECT_GT(countFromLast(drawn), 0u) << name << ": what left the picture's side";
        EXPECT_LT(findReddest(drawn.color), findReddest(drawAlone(scene).color) + 1e-3f) << name;
    }
}

TEST_F(Resolved, AppearingEntitiesHaveNoPastAndHideNothingBefore) {
    Scene scene;
    scene::hide(scene.world(), scene.box);
    HistoryFrames frames(device(), scene);
    (void)frames.at(-1);
    scene::show(scene.world(), scene.box, -0.25 / kFramesPerSecond);
    // It is static in this frame: all that is seen is in this frame's raster.
    const auto drawn = frames.at(0);
    EXPECT_EQ(countFromLast(drawn), 0u);
    EXPECT_TRUE(test::sameBits(drawn.color, drawAlone(scene).color));
    (void)frames.at(1);
    EXPECT_GT(countFromLast(frames.at(2)), 0u) << "then it moves, and has a past";
}

} // namespace
} // namespace shutter
