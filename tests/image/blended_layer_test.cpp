// SPDX-License-Identifier: MIT
// Blended surfaces that move, or that something passes: drawn at instants over the blurred picture.
#include "engine/image/metrics.h"
#include "engine/scene/history.h"
#include "modules/motion_blur/budget.h"
#include "tests/image/laws.h"
#include "tests/support/deformed_meshes.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/picture.h"
#include "tests/support/stage.h"

#include <array>
#include <cmath>
#include <limits>
#include <string_view>
#include <utility>
#include <vector>

namespace shutter {
namespace {

using test::AdaptiveLaw;
using test::Placement;
using test::SceneBuilder;
using test::Shot;

constexpr std::string_view kLayerPass = "blended layer";

/// Seen from both sides.
scene::AssetIndex addGlass(
    SceneBuilder& scene,
    const math::vec3& color,
    float alpha,
    scene::BlendMode mode = scene::BlendMode::Over
) {
    return test::addGlass(scene, math::vec4(color, alpha), true, mode);
}

/// A wall of waves four metres before the camera.
SceneBuilder makeNearWall() {
    return test::makeWavyRoom(4.0, 9.0, 6.0);
}

ecs::Entity addPane(SceneBuilder& scene, float alpha, const Placement& placement) {
    return scene.add(
        test::makeQuad(0.9, 0.7, addGlass(scene, {0.2f, 0.5f, 0.9f}, alpha)), placement
    );
}

ecs::Entity addBox(SceneBuilder& scene, const Placement& placement) {
    return test::addBox(scene, {0.5, 0.5, 0.2}, {0.9f, 0.2f, 0.1f}, placement);
}

class BlendedLayerLaw : public test::GpuTest {
  protected:
    static Shot shotBy(std::string_view method) {
        return {.method = method, .width = 192, .height = 128, .exposureSeconds = 0.25};
    }

    render::FrameResult draw(const SceneBuilder& scene, std::string_view method) {
        return test::renderOnce(device(), scene, shotBy(method));
    }

    /// Against 128 instants.
    static test::Comparison compare(const SceneBuilder& scene) {
        return {device(), scene, shotBy("sharp"), 128};
    }
};

TEST_F(BlendedLayerLaw, APaneThatMovesBlursByEachMethodAsByBruteForce) {
    SceneBuilder scene = makeNearWall();
    addPane(scene, 0.5f, {.position = {0, 0, -2}, .velocity = {1.6, 0.4, 0}});
    test::Comparison pane = compare(scene);
    const image::Image sharp = pane.render("sharp").color;
    // A filter and lookups: the others draw the same layer, or instants or rays themselves.
    for (const std::string_view method :
         test::pickMethods(test::listBlurMethods(device()), {"gather", "resolved"})) {
        const auto frame = pane.render(method);
        if (!test::hasPass(frame, kLayerPass)) {
            EXPECT_TRUE(method != "gather" && method != "resolved");
            continue;
        }
        EXPECT_GT(pane.psnr(frame), 45.0) << method;
        EXPECT_LT(image::computePsnr(sharp, frame.color), 35.0) << method;
    }
    EXPECT_FALSE(test::hasPass(pane.render("accumulate"), kLayerPass));
}

/// A scene whose layer is as by brute force, to `least` dB; a sharp picture is below `mostSharp`.
struct LayerCase {
    const char* name;
    void (*add)(SceneBuilder& scene); ///< before the wall
    double least;
    double mostSharp = std::numeric_limits<double>::infinity();
};

const LayerCase kLayerCases[] = {
    {"panes before one another have the order of the raster, and sides of a mesh that of its "
     "indices",
     [](SceneBuilder& scene) {
         const math::vec3 colors[] = {{1, 0.1f, 0.1f}, {0.1f, 1, 0.1f}, {0.1f, 0.1f, 1}};
         for (int i = 0; i < 3; ++i)
             scene.add(
                 test::makeQuad(1.0, 0.8, addGlass(scene, colors[i], 0.7f)),
                 {.position = {0, 0, -3.0 + 0.5 * i}, .velocity = {0.8 - 0.8 * i, 0.3, 0}}
             );
         scene.add(
             test::makeBox({0.5, 0.4, 0.4}, addGlass(scene, {0.9f, 0.9f, 0.2f}, 0.5f)),
             {.position = {0.8, 0, -2.5}, .velocity = {0.4, 0, 0}, .angularVelocity = {0, 1, 0}}
         );
     },
     42.0},
    {"a mover between two panes hides the far one alone",
     [](SceneBuilder& scene) {
         addPane(scene, 0.5f, {.position = {0.2, 0.1, -3}});
         addBox(scene, {.position = {0, 0, -2.5}, .velocity = {1.5, 0, 0}});
         addPane(scene, 0.5f, {.position = {-0.1, -0.1, -2}});
     },
     45.0,
     40.0},
    {"glass on a mover that comes nearer is not hidden by it",
     [](SceneBuilder& scene) {
         const Placement way{.position = {0.1, 0, -2.4}, .velocity = {1.2, 0, 2.4}};
         test::addCard(scene, {1.2, 1.0}, {0.9f, 0.2f, 0.1f}, way);
         // A millimetre in front of it, less than the resolution of a half float.
         Placement before = way;
         before.position.z += 1.0e-3;
         scene.add(test::makeQuad(0.7, 0.6, addGlass(scene, {0.1f, 0.9f, 0.2f}, 0.6f)), before);
     },
     38.0},
    {"skins and morphs of glass blur as they deform",
     [](SceneBuilder& scene) {
         const scene::AssetIndex glass = addGlass(scene, {0.9f, 0.6f, 0.1f}, 0.6f);
         const std::array<Placement, 2> joints{
             {{.position = {-0.8, -0.6, -2.5}},
              {.position = {0, 0.6, 0}, .angularVelocity = {0, 0, 2.0}}}};
         test::addSkinned(scene, test::makeStrip(0.4, 1.2, 8, glass), joints);
         scene::Primitive morph = test::makeQuad(0.5, 0.5, glass);
         morph.morphTargets.push_back(
             {.positions =
                  std::vector<math::vec3>(morph.positions.size(), math::vec3(0.5f, 0.2f, 0.0f))}
         );
         test::addMorphed(
             scene, std::move(morph), {.position = {0.7, 0, -2.5}}, {.from = {-1.0f}, .to = {1.0f}}
         );
     },
     45.0,
     40.0},
    {"a pane that crosses the camera's plane is clipped",
     [](SceneBuilder& scene) {
         addPane(scene, 0.5f, {.position = {0, 0, -0.2}, .velocity = {0, 0, 3.0}});
     },
     35.0},
    {"panes that enter the picture are seen on their way",
     [](SceneBuilder& scene) {
         addPane(scene, 0.5f, {.position = {-1.9, 0.5, -2}, .velocity = {2.4, 0, 0}});
         addPane(scene, 0.5f, {.position = {1.0, -1.3, -2}, .velocity = {0, -2.4, 0}});
     },
     45.0,
     35.0}};

TEST_F(BlendedLayerLaw, AnyMotionOfGlassIsBlurredAsByBruteForce) {
    for (const LayerCase& each : kLayerCases) {
        SCOPED_TRACE(each.name);
        SceneBuilder scene = makeNearWall();
        each.add(scene);
        test::Comparison layer = compare(scene);
        const auto frame = layer.render("resolved");
        EXPECT_TRUE(test::hasPass(frame, kLayerPass));
        EXPECT_TRUE(test::allFinite(frame.color));
        EXPECT_GT(layer.psnr(frame), each.least);
        EXPECT_LT(layer.psnr("sharp"), each.mostSharp);
    }
}

TEST_F(BlendedLayerLaw, GlassThatNothingPassesStaysInTheRaster) {
    SceneBuilder scene = makeNearWall();
    addPane(scene, 0.5f, {.position = {-1.2, 0, -3}});
    addBox(scene, {.position = {1.2, 0, -3}, .velocity = {0, 1, 0}});
    EXPECT_FALSE(test::hasPass(draw(scene, "resolved"), kLayerPass));
    // Only a camera that sees it move against the wall takes it out.
    const double before = -3.0;
    const double onWall = -3.999;
    for (const double depth : {before, onWall}) {
        SceneBuilder still = makeNearWall();
        addPane(still, 0.5f, {.position = {-1.2, 0, depth}});
        still.moveCamera({.velocity = {1, 0, 0}});
        EXPECT_EQ(test::hasPass(draw(still, "resolved"), kLayerPass), depth == before) << depth;
    }
}

TEST_F(BlendedLayerLaw, AClearPaneChangesNoBit) {
    SceneBuilder without = makeNearWall();
    addBox(without, {.position = {0, 0, -3}, .velocity = {-1.5, 0, 0}});
    SceneBuilder with = makeNearWall();
    addBox(with, {.position = {0, 0, -3}, .velocity = {-1.5, 0, 0}});
    addPane(with, 0.0f, {.position = {0, 0, -2}, .velocity = {1.6, 0, 0}});
    for (const std::string_view method : {"gather", "own_velocity"}) {
        const auto frame = draw(with, method);
        EXPECT_TRUE(test::hasPass(frame, kLayerPass)) << method;
        EXPECT_TRUE(test::sameBits(frame.color, draw(without, method).color)) << method;
    }
    // Its background is summed up from parts of the exposure: to half precision.
    EXPECT_GT(
        image::computePsnr(draw(with, "resolved").color, draw(without, "resolved").color), 65.0
    );
}

TEST_F(BlendedLayerLaw, APaneOfTheBackgroundsColourIsNotSeen) {
    SceneBuilder scene = test::makeView();
    const math::vec3 grey(0.4f);
    test::addCard(scene, {9.0, 6.0}, grey, {.position = {0, 0, -4}});
    for (const double speed : {1.0, -2.5})
        scene.add(
            test::makeQuad(0.9, 0.7, addGlass(scene, grey, 0.6f)),
            {.position = {0, 0.1 * speed, -2}, .velocity = {speed, 0, 0}}
        );
    const auto frame = draw(scene, "resolved");
    EXPECT_TRUE(test::hasPass(frame, kLayerPass));
    // 15 sums in half floats, of steps of 2.4e-4.
    EXPECT_LT(image::computeMaxDifference(frame.color, draw(scene, "sharp").color), 2.0e-3);
}

TEST_F(BlendedLayerLaw, ABoxOfGlassOfManyColoursThatHardlyMovesIsTheRasters) {
    SceneBuilder slow = makeNearWall();
    const auto material = addGlass(slow, {1, 1, 1}, 0.5f);
    slow.world.assets.materials[material].baseColor.texture = slow.addWaveTexture();
    slow.add(
        test::makeBox({0.8, 0.7, 0.7}, material),
        {.position = {0.3, 0.2, -2.5}, .velocity = {0.002, 0, 0}}
    );
    const auto frame = draw(slow, "resolved");
    EXPECT_TRUE(test::hasPass(frame, kLayerPass));
    EXPECT_GT(image::computePsnr(frame.color, draw(slow, "sharp").color), 55.0);
}

TEST_F(BlendedLayerLaw, AStaticPostHidesAPaneAtEachInstant) {
    const auto isOfPost = [](uint32_t x, uint32_t) { return x >= 88 && x < 104; };
    for (const std::string_view method : {"resolved", "gather"}) {
        SceneBuilder without = makeNearWall();
        SceneBuilder with = makeNearWall();
        for (SceneBuilder* scene : {&without, &with})
            scene->add(
                test::makeBox({0.18, 2.0, 0.02}, scene->addColor({0.1f, 0.8f, 0.3f})),
                {.position = {0, 0, -1}}
            );
        addPane(with, 0.6f, {.position = {0, 0, -2}, .velocity = {1.6, 0, 0}});
        EXPECT_LT(
            test::computeMaxDifferenceWhere(
                draw(with, method).color, draw(without, "sharp").color, isOfPost
            ),
            1.0e-3
        ) << method;
    }
}

TEST_F(BlendedLayerLaw, GlassThatAMoverHidesAtEachInstantIsNeverSeen) {
    // Behind it, as fast in the picture, and smaller: 60 pixels, four from instant to instant.
    const auto make = [](bool hasGlass) {
        SceneBuilder scene = makeNearWall();
        for (const double y : {0.35, -0.35})
            test::addCard(
                scene,
                {0.3, 0.4},
                {0.9f, 0.2f, 0.1f},
                {.position = {0, y, -2}, .velocity = {3.6, 0, 0}}
            );
        if (!hasGlass)
            return scene;
        const auto glass = addGlass(scene, {0.1f, 0.9f, 0.2f}, 0.9f);
        scene::Primitive quad = test::makeQuad(0.33, 0.4, glass);
        scene.add(quad, {.position = {0, 0.4375, -2.5}, .velocity = {4.5, 0, 0}});
        scene::Primitive morph = quad;
        morph.morphTargets.push_back(
            {.positions = std::vector<math::vec3>(quad.positions.size(), math::vec3(4.5f, 0, 0))}
        );
        test::addMorphed(
            scene,
            std::move(morph),
            {.position = {0, -0.4375, -2.5}},
            {.from = {-1.0f}, .to = {1.0f}}
        );
        return scene;
    };
    const auto frame = draw(make(true), "resolved");
    EXPECT_TRUE(test::hasPass(frame, kLayerPass));
    EXPECT_LT(
        image::computeMaxDifference(frame.color, draw(make(false), "resolved").color), 5.0e-3
    );
}

TEST_F(BlendedLayerLaw, JointCoverageByAPaneAndAMoverIsNotSeparated) {
    // Glass that moves with the surfaces that it covers: compositing means would mix them.
    SceneBuilder scene = makeNearWall();
    addBox(scene, {.position = {0, 0, -2.6}, .velocity = {2.4, 0, 0}});
    scene.add(
        test::makeQuad(0.42, 0.42, addGlass(scene, {0.1f, 0.2f, 0.9f}, 0.7f)),
        {.position = {0, 0, -2.4}, .velocity = {2.4, 0, 0}}
    );
    test::Comparison joint = compare(scene);
    const double resolved = joint.psnr("resolved");
    EXPECT_GT(resolved, joint.psnr("gather") + 6.0);
    EXPECT_GT(resolved, 42.0);
    // A part per instant is composited over the background of its instant.
    Shot few = shotBy("resolved");
    few.settings.sampleCount = 4;
    EXPECT_GT(test::Comparison(device(), scene, few, 4).psnr("resolved"), 42.0);
}

TEST_F(BlendedLayerLaw, AnExcludedPaneStaysSharp) {
    SceneBuilder scene = makeNearWall();
    const ecs::Entity pane =
        addPane(scene, 0.5f, {.position = {0, 0, -2}, .velocity = {1.6, 0, 0}});
    scene.world.registry.add(pane, scene::MotionBlur{.scale = 0.0});
    addBox(scene, {.position = {0, 1.0, -3}, .velocity = {0, -4, 0}});
    const auto frame = draw(scene, "resolved");
    EXPECT_TRUE(test::hasPass(frame, kLayerPass));
    const auto above = [](uint32_t, uint32_t y) { return y > 74; };
    EXPECT_LT(
        test::computeMaxDifferenceWhere(frame.color, draw(scene, "sharp").color, above), 2.0e-3
    );
}

TEST_F(BlendedLayerLaw, APaneBeforeAMovingCameraIsHiddenWhereTheRasterSeesIt) {
    SceneBuilder scene = makeNearWall();
    test::addBox(scene, {0.2, 2.0, 0.02}, {0.1f, 0.8f, 0.3f}, {.position = {0, 0, -1.5}});
    addPane(scene, 0.6f, {.position = {0, 0, -2}, .velocity = {0.8, 0, 0}});
    scene.moveCamera({.angularVelocity = {0, 0.3, 0}});
    // Filters know the raster's depth alone. A lookup with the instant's camera instead of the
    // raster's would give 35.9.
    EXPECT_GT(compare(scene).psnr("own_velocity"), 39.0);
}

TEST_F(BlendedLayerLaw, MirroredAndReversedScenesGiveMirroredAndEqualPictures) {
    const auto make = [](double side, double time) {
        SceneBuilder scene = test::makeView();
        test::addCard(scene, {9.0, 6.0}, {0.2f, 0.3f, 0.1f}, {.position = {0, 0, -4}});
        addPane(
            scene,
            0.5f,
            {.position = {0.3 * side, 0, -2}, .velocity = {1.2 * side * time, 0.2 * time, 0}}
        );
        addBox(scene, {.position = {-0.2 * side, 0.2, -3}, .velocity = {-side * time, 0, 0}});
        return scene;
    };
    const image::Image plain = draw(make(1.0, 1.0), "resolved").color;
    EXPECT_GT(
        image::computePsnr(test::mirror(draw(make(-1.0, 1.0), "resolved").color), plain), 50.0
    );
    EXPECT_GT(image::computePsnr(draw(make(1.0, -1.0), "resolved").color, plain), 45.0);
}

TEST_F(BlendedLayerLaw, AFrameAfterOneThatHadThePaneInItsRasterDoesNotSeeItTwice) {
    // A box comes near a still pane in the second frame: it is in the first one's raster.
    SceneBuilder scene = makeNearWall();
    addPane(scene, 0.7f, {.position = {0.4, 0, -2}});
    addBox(scene, {.position = {-1.6, 0, -3}, .velocity = {24.0, 0, 0}});
    const auto shotAt = [](int frame) {
        return Shot{
            .method = "resolved",
            .width = 192,
            .height = 128,
            .seconds = frame / 30.0,
            .exposureSeconds = 1.0 / 60.0,
            .phase = scene::ShutterPhase::End,
            .frameSeconds = 1.0 / 30.0};
    };
    test::Frames frames(device(), scene);
    bool hadNone = false;
    bool changed = false;
    for (int i = 0; i < 4; ++i) {
        const auto frame = frames.draw(shotAt(i));
        const bool has = test::hasPass(frame, kLayerPass);
        changed = changed || (has && hadNone);
        hadNone = !has;
        test::Frames alone(device(), scene);
        EXPECT_TRUE(test::sameBits(frame.color, alone.draw(shotAt(i)).color)) << i;
    }
    EXPECT_TRUE(changed) << "the pane leaves the raster between two frames";
}

TEST_F(BlendedLayerLaw, ALayerOverAStaticWallIsTheMeanOfItsInstants) {
    SceneBuilder scene = makeNearWall();
    addPane(scene, 0.5f, {.position = {0, 0, -2}, .velocity = {1.6, 0.4, 0}});
    for (const auto shape : {scene::ResponseShape::Box, scene::ResponseShape::Triangle}) {
        Shot shot = shotBy("resolved");
        shot.shutter.response.shape = shape;
        const auto frame = test::renderOnce(device(), scene, shot);
        shot.method = "accumulate";
        shot.instants = uint32_t(frame.statistics.counters.at("blended instants"));
        EXPECT_GT(shot.instants, 8u);
        EXPECT_LT(shot.instants, 15u) << "as many as its way takes";
        const image::Image mean = test::renderOnce(device(), scene, shot).color;
        EXPECT_GT(image::computePsnr(frame.color, mean), 60.0);
    }
}

TEST_F(BlendedLayerLaw, GlassThatNothingShinesThroughIsTheSamePaneWithoutBlending) {
    const math::vec3 color(0.2f, 0.5f, 0.9f);
    const auto make = [&](bool isGlass) {
        SceneBuilder scene = makeNearWall();
        addBox(scene, {.position = {0.3, 0.1, -3}, .velocity = {-1.5, 0, 0}});
        const auto material = isGlass ? addGlass(scene, color, 1.0f) : scene.addColor(color);
        scene.add(
            test::makeQuad(0.9, 0.7, material), {.position = {0, 0, -2}, .velocity = {1.6, 0.4, 0}}
        );
        return scene;
    };
    const auto glass = draw(make(true), "resolved");
    EXPECT_TRUE(test::hasPass(glass, kLayerPass));
    Shot truth = shotBy("accumulate");
    truth.instants = 128;
    EXPECT_GT(
        image::computePsnr(glass.color, test::renderOnce(device(), make(false), truth).color), 45.0
    );
}

TEST_F(BlendedLayerLaw, ThePictureIsSharpWithoutAnExposureOrAtACut) {
    SceneBuilder scene = makeNearWall();
    addBox(scene, {.position = {0, 0, -3}, .velocity = {-1.5, 0, 0}});
    addPane(scene, 0.5f, {.position = {0, 0, -2}, .velocity = {1.6, 0, 0}});
    const image::Image sharp = draw(scene, "sharp").color;
    Shot shot = shotBy("resolved");
    shot.exposureSeconds = 0.0;
    EXPECT_TRUE(test::sameBits(test::renderOnce(device(), scene, shot).color, sharp));
    EXPECT_FALSE(test::sameBits(draw(scene, "resolved").color, sharp));
    scene::cut(scene.world, scene.camera, 0.0);
    const auto frame = draw(scene, "resolved");
    EXPECT_FALSE(test::hasPass(frame, kLayerPass));
    EXPECT_TRUE(test::sameBits(frame.color, sharp));
}

TEST_F(BlendedLayerLaw, ASurfaceIsSeenFromItsFrontAloneAlsoWhereItIsMirrored) {
    SceneBuilder scene = makeNearWall();
    const auto glass = addGlass(scene, {0.2f, 0.5f, 0.9f}, 0.6f);
    scene.world.assets.materials[glass].doubleSided = false;
    const auto mesh = scene.addMesh({test::makeQuad(0.5, 0.5, glass)});
    const math::dquat away = glm::angleAxis(glm::pi<double>(), math::dvec3(0, 1, 0));
    const auto add = [&](double x, const Placement& placement) {
        Placement placed = placement;
        placed.position = {x, 0, -2};
        placed.velocity = {0, 1.2, 0};
        scene.add(mesh, placed);
    };
    add(-0.9, {});
    add(-0.3, {.scale = {-1, 1, 1}});
    add(0.3, {.rotation = away});
    add(0.9, {.rotation = away, .scale = {-1, 1, 1}});
    test::Comparison sides = compare(scene);
    const auto frame = sides.render("resolved");
    EXPECT_GT(sides.psnr(frame), 45.0);
    const image::Image& picture = frame.color;
    const image::Image wall = draw(makeNearWall(), "resolved").color;
    const auto isInHalf = [](bool right) {
        return [right](uint32_t x, uint32_t) { return (x >= 96) == right; };
    };
    EXPECT_GT(test::computeMaxDifferenceWhere(picture, wall, isInHalf(false)), 0.1);
    EXPECT_EQ(test::computeMaxDifferenceWhere(picture, wall, isInHalf(true)), 0.0);
}

TEST_F(BlendedLayerLaw, EachLevelOfABudgetIsBetterThanSharpAndHasTheSameBitsAgain) {
    SceneBuilder scene = makeNearWall();
    addBox(scene, {.position = {0.4, 0.1, -3}, .velocity = {-2.0, 0, 0}});
    addPane(scene, 0.5f, {.position = {0, 0, -2}, .velocity = {2.4, 0.4, 0}});
    test::Comparison blur = compare(scene);
    const double sharp = blur.psnr("sharp");
    const auto levels = motion_blur::makeLevels({.method = &motion_blur::getMethod("resolved")});
    ASSERT_GE(levels.size(), 4u);
    for (size_t level = 0; level < levels.size(); ++level) {
        Shot shot = shotBy(levels[level].settings.method->name);
        shot.settings = levels[level].settings;
        const auto frame = test::renderOnce(device(), scene, shot);
        EXPECT_TRUE(test::hasPass(frame, kLayerPass)) << level;
        EXPECT_GT(blur.psnr(frame), sharp + 1.0) << level;
        EXPECT_TRUE(test::sameBits(frame.color, test::renderOnce(device(), scene, shot).color))
            << level;
    }
}

/// Two panes of a mode that cross before the wall, one within the other's reach.
SceneBuilder makeGlow(scene::BlendMode mode) {
    SceneBuilder scene = makeNearWall();
    for (const double side : {1.0, -1.0})
        scene.add(
            test::makeQuad(0.9, 0.7, addGlass(scene, {0.2f, 0.3f, 0.1f}, 0.6f, mode)),
            {.position = {0.2 * side, 0, -2.0 - 0.3 * side}, .velocity = {1.2 * side, 0.2, 0}}
        );
    return scene;
}

TEST_F(BlendedLayerLaw, LightThatIsAddedAndPremultipliedColoursBlurAsByBruteForce) {
    for (const scene::BlendMode mode : {scene::BlendMode::Add, scene::BlendMode::Premultiplied}) {
        const SceneBuilder scene = makeGlow(mode);
        test::Comparison glow = compare(scene);
        for (const std::string_view method : {"resolved", "gather"})
            EXPECT_GT(glow.psnr(method), 45.0) << method;
    }
    // Additive light hides nothing: no pixel is darker than without it.
    const image::Image with = draw(makeGlow(scene::BlendMode::Add), "sharp").color;
    const image::Image without = draw(makeNearWall(), "sharp").color;
    for (size_t i = 0; i < with.pixels.size(); ++i)
        ASSERT_GE(with.pixels[i], without.pixels[i] - 1.0e-3f);
    EXPECT_FALSE(test::sameBits(with, without));
}

TEST_F(BlendedLayerLaw, RaysAddLightAsTheRasterDoes) {
    if (!device().hasRayQuery())
        GTEST_SKIP() << "needs ray queries";
    for (const scene::BlendMode mode : {scene::BlendMode::Add, scene::BlendMode::Premultiplied}) {
        Shot shot{.method = "truth", .width = 192, .height = 128, .exposureSeconds = 1.0e-6};
        shot.instants = 4;
        const SceneBuilder scene = makeGlow(mode);
        const image::Image traced = test::renderOnce(device(), scene, shot).color;
        shot.method = "sharp";
        EXPECT_GT(image::computePsnr(traced, test::renderOnce(device(), scene, shot).color), 40.0);
    }
}

void expectNoRayMeetsThePane(std::string_view method, double least) {
    SceneBuilder scene = makeNearWall();
    addBox(scene, {.position = {0, 0, -3}, .velocity = {2.0, 0, 0}});
    addPane(scene, 0.8f, {.position = {0, 0, -2}});
    Shot shot{.width = 192, .height = 128, .exposureSeconds = 0.25};
    shot.settings.raysPerPixel = 1.0f;
    test::Comparison pane(test::sharedDevice(), scene, shot, 128);
    const auto frame = pane.render(method);
    EXPECT_GT(frame.statistics.counters.at("rays traced"), 100u);
    EXPECT_GT(pane.psnr(frame), least);
}

TEST_F(BlendedLayerLaw, NoRevealMeetsAPaneOfTheLayer) {
    if (!device().hasRayQuery())
        GTEST_SKIP() << "needs ray queries";
    expectNoRayMeetsThePane("hybrid", 33.0);
}

TEST_F(AdaptiveLaw, NoRayMeetsAPaneOfTheLayer) {
    expectNoRayMeetsThePane("adaptive", 45.0);
}

} // namespace
} // namespace shutter
