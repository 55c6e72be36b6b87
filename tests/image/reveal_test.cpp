// SPDX-License-Identifier: MIT
// What rays reveal behind a mover is what raster draws when the mover is not there; one traversal
// reveals what stepping from hit to hit reveals; the three tests of the ray mask, each taken away
// in turn; the table of alpha modes in modules/motion_blur/limits.md, cell by cell.
#include "assets/generator/hard_cases.h"
#include "assets/generator/scenes.h"
#include "engine/image/metrics.h"
#include "game/options/shot_arguments.h"
#include "tests/image/laws.h"
#include "tests/support/deformed_meshes.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/picture.h"
#include "tests/support/stage.h"
#include "tests/support/temp_folder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <ostream>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace shutter {
namespace {

using math::dvec3;
using math::vec4;
using motion_blur::RevealTraversal;
using scene::Material;
using test::Placement;
using test::SceneBuilder;
using test::Shot;
using test::Stage;
using AddToScene = std::function<void(SceneBuilder&)>;

class RevealLaw : public test::RayTest {};

Shot revealShot() {
    return {
        .method = "hybrid",
        .background = math::vec3(0.2f, 0.3f, 0.4f),
        .aovs = {"mask", "reveal", "reveal_motion", "motion", "mesh_id"}};
}

void addOccluder(SceneBuilder& scene) {
    test::addCard(
        scene, {0.9, 0.9}, {1, 0, 0.9f}, {.position = {0.05, -0.03, -2}, .velocity = {0.35, 0.1, 0}}
    );
}

Placement wall() {
    return {
        .position = {0, 0, -4},
        .rotation = glm::angleAxis(0.4, glm::normalize(dvec3(0.3, 1.0, 0.0)))};
}

/// Two double-sided slabs, one behind the other, joined below the picture: four surfaces on a ray.
void addPronged(SceneBuilder& scene) {
    const auto color = scene.addColor({1, 0, 0.9f});
    const auto near = test::makeBox({0.9, 0.9, 0.1}, color);
    scene.world.assets.materials.back().doubleSided = true;
    const auto far = test::transformed(near, glm::translate(math::dmat4(1.0), dvec3(0, 0, -0.5)));
    const auto mesh = scene.addMesh({near, far});
    scene.add(mesh, {.position = {0.05, -0.03, -1.95}, .velocity = {0.35, 0.1, 0}});
}

struct RevealCase {
    const char* name;
    AddToScene background;
    AddToScene occluder = addOccluder;
    Shot shot = revealShot();
    /// Pixels that must be in the mask for the case to mean anything.
    size_t leastMasked = 150;
    /// Of the background, somewhere behind the mask; the revealed motion is the raster's. Below 0:
    /// not tested.
    double leastMotionPx = -1.0;
    /// Then the occluder's pixels alone count, the last entity's.
    bool backgroundMoves = leastMotionPx >= 0.0;
};

/// Renders the background with and without the occluder; inside the mask the revealed colour of the
/// first must be the raster of the second to 1/255.
void expectRevealIsRaster(gpu::Device& device, const RevealCase& law) {
    SCOPED_TRACE(law.name);
    SceneBuilder alone = test::makeView();
    law.background(alone);
    SceneBuilder both = test::makeView();
    law.background(both);
    law.occluder(both);
    Shot sharp = law.shot;
    sharp.method = "sharp";
    const auto drawn = test::renderOnce(device, alone, sharp);
    const image::Image& expected = drawn.color;
    const auto result = test::renderOnce(device, both, law.shot);
    ASSERT_TRUE(result.intermediates.contains("mask"));
    const image::Image& mask = result.intermediates.at("mask");
    EXPECT_GT(test::countSet(mask), law.leastMasked);
    const image::Image& ids = result.intermediates.at("mesh_id");
    const float occluder = test::findBrightest(ids);
    const auto masked = [&](uint32_t x, uint32_t y) {
        return mask.at(x, y, 0) > 0.5f && (!law.backgroundMoves || ids.at(x, y, 0) == occluder);
    };
    const image::Image& reveal = result.intermediates.at("reveal");
    EXPECT_LE(test::computeMaxDifferenceWhere(reveal, expected, masked), 1.0 / 255.0);
    // The law is void if the occluder has the colour of the surface behind it.
    const auto hidden = test::renderOnce(device, both, sharp).color;
    EXPECT_GT(test::computeMaxDifferenceWhere(hidden, expected, masked), 0.2);
    const image::Image& motion = drawn.intermediates.at("motion");
    const image::Image& revealed = result.intermediates.at("reveal_motion");
    double longest = 0.0;
    size_t compared = 0;
    for (uint32_t y = 0; y < mask.height && law.leastMotionPx >= 0.0; ++y)
        for (uint32_t x = 0; x < mask.width; ++x)
            for (uint32_t c = 0; c < 2 && masked(x, y); ++c) {
                ASSERT_NEAR(revealed.at(x, y, c), motion.at(x, y, c), 0.02) << x << ", " << y;
                longest = std::max(longest, std::abs(double(motion.at(x, y, c))));
                ++compared;
            }
    EXPECT_GE(longest, law.leastMotionPx);
    EXPECT_TRUE(law.leastMotionPx < 0.0 || compared > 200u) << compared;
}

void addWall(SceneBuilder& scene) {
    scene.add(test::makeQuad(5, 4, scene.addWaves()), wall());
}

TEST_F(RevealLaw, RevealedSurfacesAreThoseOfARasterWithoutTheMover) {
    std::vector<RevealCase> cases = {
        {"a textured wall", addWall},
        {"a mirrored box, whose own front must not be lost, nor the back come through",
         [](SceneBuilder& scene) {
             scene.add(
                 test::makeBox({1.6, 1.6, 0.6}, scene.addWaves()),
                 {.position = {0, 0, -4},
                  .rotation = glm::angleAxis(0.4, dvec3(0, 1, 0)),
                  .scale = {-1.5, 1, 1}}
             );
             test::addCard(scene, {9, 7}, {0, 0.5f, 0}, {.position = {0, 0, -6}});
         }},
        // z scaled by -1 keeps the corners but turns the winding: raster culls it, rays must too.
        {"a mirrored quad that turns its back",
         [](SceneBuilder& scene) {
             test::addCard(
                 scene, {5, 4}, {1, 1, 0}, {.position = {0, 0, -3}, .scale = {-1, -1, -1}}
             );
             addWall(scene);
         }},
        {"holes of an alpha mask",
         [](SceneBuilder& scene) {
             const auto leaves = scene.addWaves(true);
             // Level 0 of its texture (nearest, below one texel per pixel): both give the same
             // border of the hole.
             scene.world.assets.textures.back().nearest = true;
             scene.add(test::makeQuad(9, 9, leaves), {.position = {0.03, 0.02, -3}});
             addWall(scene);
         }},
        {"the back of a double-sided wall",
         [](SceneBuilder& scene) {
             scene.add(
                 test::makeQuad(5, 4, scene.addTextured(scene.addWaveTexture(), true)),
                 {.position = {0, 0, -4}, .rotation = glm::angleAxis(2.8, dvec3(0, 1, 0))}
             );
         }},
        {"a texture transform",
         [](SceneBuilder& scene) {
             Material material;
             material.unlit = true;
             material.baseColor = {scene.addWaveTexture(), 0, {0.3f, -0.2f}, 0.7f, {2.5f, 1.3f}};
             scene.add(test::makeQuad(5, 4, scene.addMaterial(material)), wall());
         }},
        // From the front: a single-sided part that turns its back, then, side by side, the back of
        // a double-sided part and the front of a single-sided one.
        {"single-sided and double-sided parts of one mesh",
         [](SceneBuilder& scene) {
             const auto texture = scene.addWaveTexture();
             const auto around = glm::rotate(math::dmat4(1.0), 3.0, dvec3(0, 1, 0));
             const auto part = [&](double width,
                                   scene::AssetIndex material,
                                   const dvec3& place,
                                   const math::dmat4& turn) {
                 return test::transformed(
                     test::makeQuad(width, 4, material),
                     glm::translate(math::dmat4(1.0), place) * turn
                 );
             };
             scene.add(
                 scene.addMesh(
                     {part(4, scene.addColor({1, 1, 0}), {0, 0, 1}, around),
                      part(2, scene.addTextured(texture, true), {-1, 0, 0}, around),
                      part(2, scene.addTextured(texture), {1, 0, -0.2}, math::dmat4(1.0))}
                 ),
                 {.position = {0, 0, -4}}
             );
         }},
        {"an orthographic camera",
         [](SceneBuilder& scene) {
             scene.setPixelView(64);
             Placement placement = wall();
             placement.position = {0, 0, -50};
             scene.add(test::makeQuad(110, 90, scene.addWaves()), placement);
         },
         [](SceneBuilder& scene) {
             test::addCard(
                 scene, {30, 30}, {1, 0, 0.9f}, {.position = {1.3, 0.4, -5}, .velocity = {11, 4, 0}}
             );
         }},
        // More movers than masks, all behind the camera and larger than the one in front: that one
        // is passed candidate by candidate.
        {"movers without masks of their own",
         [](SceneBuilder& scene) {
             addWall(scene);
             const auto color = scene.addColor({0, 1, 0});
             for (int i = 0; i < 40; ++i)
                 scene.add(
                     test::makeQuad(9, 9, color),
                     {.position = {0, 0, 2.0 + 0.01 * i}, .velocity = {0.1, 0, 0}}
                 );
         },
         addPronged}};
    for (const auto phase : {scene::ShutterPhase::Start, scene::ShutterPhase::End}) {
        cases.push_back({"in another phase", addWall});
        cases.back().shot.phase = phase;
    }
    // A row is 256 groups of 64 pixels.
    cases.push_back(
        {.name = "more pixels than one row of groups holds",
         .background = [](SceneBuilder& scene
                       ) { scene.add(test::makeQuad(9, 9, scene.addWaves()), wall()); },
         .leastMasked = 256 * 64 + 64}
    );
    cases.back().shot.width = 960;
    cases.back().shot.height = 720;
    cases.push_back({"a concave mover by enough levels", addWall, addPronged});
    cases.back().shot.settings.revealTraversal = motion_blur::RevealTraversal::Stepping;
    cases.back().shot.settings.recursionLimit = 5; // four surfaces of its own, then the wall
    cases.push_back({"a concave mover by one traversal", addWall, addPronged});
    cases.back().shot.settings.recursionLimit = 1; // of stepping alone
    cases.push_back(
        {"another luminance than the waves', which stay below 0.9",
         addWall,
         [](SceneBuilder& scene) {
             test::addBox(
                 scene,
                 {0.9, 0.9, 0.2},
                 {1, 1, 1},
                 {.position = {0.05, -0.03, -2}, .velocity = {0.35, 0.1, 0}}
             );
         }}
    );
    cases.back().shot.settings.objectTest = motion_blur::ObjectTest::Luminance;
    for (const RevealCase& law : cases)
        expectRevealIsRaster(device(), law);
}

/// A wall of 6 m that bends back and forth.
AddToScene bendingWall(const dvec3& scale) {
    return [scale](SceneBuilder& scene) {
        const std::array joints{
            Placement{.position = {0, -3, -4}, .scale = scale, .angularVelocity = {0, 0.1, 0}},
            Placement{.position = {0, 3, 0}, .angularVelocity = {0.2, 0.1, 0.3}}};
        test::addSkinned(scene, test::makeStrip(7.0, 6.0, 10, scene.addWaves()), joints);
    };
}

TEST_F(RevealLaw, DeformedMeshesAreHitWhereTheRasterDrawsThemWithItsMotion) {
    const RevealCase cases[] = {
        {.name = "a bending wall", .background = bendingWall(dvec3(1)), .leastMotionPx = 2.0},
        {.name = "a mirrored single-sided wall",
         .background = bendingWall(dvec3(-1, 1, 1)),
         .leastMotionPx = 2.0},
        {.name = "a morphing wall",
         .background =
             [](SceneBuilder& scene) {
                 scene::Primitive wall = test::makeStrip(7.0, 6.0, 10, scene.addWaves());
                 scene::MorphTarget& target = wall.morphTargets.emplace_back();
                 for (const math::vec3& position : wall.positions)
                     target.positions.push_back({0.3f * position.y, 0.0f, 0.2f * position.x});
                 const Placement place{.position = {0, -3, -4}, .angularVelocity = {0, 0.1, 0}};
                 test::addMorphed(scene, wall, place, {{0.0f}, {1.0f}});
             },
         .leastMotionPx = 2.0},
        {.name = "a wall behind a bending strip",
         .background = addWall,
         .occluder =
             [](SceneBuilder& scene) {
                 const std::array joints{
                     Placement{.position = {-0.1, -0.5, -2}, .velocity = {0.35, 0, 0}},
                     Placement{.position = {0, 0.5, 0}, .angularVelocity = {0, 0, 0.8}}};
                 const auto color = scene.addColor({1, 0, 0.9f});
                 test::addSkinned(scene, test::makeStrip(0.7, 1.0, 10, color), joints);
             },
         .leastMasked = 100,
         .leastMotionPx = 0.0}};
    for (const RevealCase& law : cases)
        expectRevealIsRaster(device(), law);
}

TEST_F(RevealLaw, TooFewLevelsEndInsideAConcaveOccluder) {
    SceneBuilder scene = test::makeView();
    addWall(scene);
    addPronged(scene);
    Shot shot = revealShot();
    shot.settings.revealTraversal = motion_blur::RevealTraversal::Stepping;
    shot.settings.recursionLimit = 3;
    shot.settings.composite = motion_blur::CompositeRule::Weights; // its mask is larger
    const auto result = test::renderOnce(device(), scene, shot);
    const image::Image& mask = result.intermediates.at("mask");
    const image::Image& reveal = result.intermediates.at("reveal");
    // The third surface is the far slab's front, half a side of 0.45 m at 2.45 m; one pixel less.
    const double focalPx = 32.0 / std::tan(0.45);
    const double halfPx = focalPx * 0.45 / 2.45 - 1.0;
    const math::dvec2 centre(48.0 + focalPx * 0.05 / 2.45, 32.0 + focalPx * 0.03 / 2.45);
    size_t compared = 0;
    for (uint32_t y = 0; y < 64; ++y)
        for (uint32_t x = 0; x < 96; ++x) {
            const math::dvec2 offset = glm::abs(math::dvec2(x + 0.5, y + 0.5) - centre);
            if (mask.at(x, y, 0) < 0.5f || std::max(offset.x, offset.y) > halfPx)
                continue;
            ++compared;
            ASSERT_GT(reveal.at(x, y, 0), 0.99f) << x << ", " << y;
            ASSERT_LT(reveal.at(x, y, 1), 0.01f) << x << ", " << y;
        }
    EXPECT_GT(compared, 150u);
}

TEST_F(RevealLaw, TheLuminanceTestPassesObjectsOfEqualLuminanceAndTheMeshTestDoesNot) {
    // Two white slabs of one luminance before the wall. By mesh id the second is another object; by
    // luminance it is the same, and the wall is revealed.
    const auto occluders = [](SceneBuilder& scene) {
        addWall(scene);
        const auto white = scene.addColor({1, 1, 1}); // the waves stay below 0.9
        scene.add(test::makeQuad(3, 3, white), {.position = {0, 0, -3}});
        scene.add(
            test::makeQuad(0.9, 0.9, white),
            {.position = {0.05, -0.03, -2}, .velocity = {0.35, 0.1, 0}}
        );
    };
    SceneBuilder scene = test::makeView();
    occluders(scene);
    SceneBuilder alone = test::makeView();
    addWall(alone);
    const auto wallOnly = test::renderOnce(device(), alone, {});
    Stage stage(device(), scene);
    for (auto objectTest : {motion_blur::ObjectTest::MeshId, motion_blur::ObjectTest::Luminance}) {
        Shot shot = revealShot();
        shot.settings.objectTest = objectTest;
        const auto result = stage.render(shot);
        const image::Image& mask = result.intermediates.at("mask");
        ASSERT_GT(test::countSet(mask), 150u);
        image::Image expected = wallOnly.color;
        if (objectTest == motion_blur::ObjectTest::MeshId)
            expected.pixels.assign(expected.pixels.size(), 1.0f);
        EXPECT_LE(
            test::computeMaxDifferenceWhere(
                result.intermediates.at("reveal"),
                expected,
                [&](uint32_t x, uint32_t y) { return mask.at(x, y, 0) > 0.5f; }
            ),
            1.0 / 255.0
        );
    }
}

TEST_F(RevealLaw, OnlyTheBackgroundColourIsRevealedInFrontOfTheSky) {
    SceneBuilder scene = test::makeView();
    addOccluder(scene);
    const Shot shot = revealShot();
    const auto result = test::renderOnce(device(), scene, shot);
    const image::Image& mask = result.intermediates.at("mask");
    const image::Image& reveal = result.intermediates.at("reveal");
    ASSERT_GT(test::countSet(mask), 150u);
    for (uint32_t y = 0; y < 64; ++y)
        for (uint32_t x = 0; x < 96; ++x)
            for (uint32_t c = 0; c < 3; ++c)
                if (mask.at(x, y, 0) > 0.5f) {
                    // One conversion to half floats.
                    ASSERT_NEAR(reveal.at(x, y, c), shot.background[int(c)], 0.4f / 1024.0f);
                }
}

struct SceneCase {
    std::string name;
    generator::GltfWriter (*build)();
    std::string camera = "main";
    double seconds = 0.0;
    double exposureSeconds = generator::kCaseExposureSeconds;
    std::string phase = "end";
};

/// Without it the test's name would hold the bytes of a pointer.
void PrintTo(const SceneCase& scene, std::ostream* stream) {
    *stream << scene.name;
}

std::vector<SceneCase> listScenes() {
    constexpr double kOpenTime = 1.0 / 30.0;
    std::vector<SceneCase> scenes = {
        {"vase", &generator::buildVaseScene, "main", 0.0, kOpenTime},
        {"courtyard", &generator::buildCourtyardScene, "main", 0.2, kOpenTime},
        {"courtyard_pan", &generator::buildCourtyardScene, "pan", 0.2, kOpenTime}};
    for (const generator::BenchCase& hard : generator::listHardCases())
        if (!hard.movesParticles) // which reveal nothing
            scenes.push_back(
                {hard.name,
                 hard.build,
                 hard.camera,
                 hard.timeSeconds,
                 hard.exposureSeconds,
                 hard.phase}
            );
    // Rays that meet the most surfaces of one object, and a background that moves.
    if (!test::drawsAll())
        std::erase_if(scenes, [](const SceneCase& scene) {
            return scene.name != "vase" && scene.name != "courtyard_pan";
        });
    return scenes;
}

class RevealOfScenes : public test::RayTest, public testing::WithParamInterface<SceneCase> {
  protected:
    void SetUp() override {
        RayTest::SetUp();
        if (IsSkipped() || HasFatalFailure())
            return;
        const SceneCase& scene = GetParam();
        const test::TempFolder folder;
        game::ShotArguments arguments;
        arguments.scene = (folder.path() / "scene.glb").string();
        ASSERT_EQ(scene.build().write(arguments.scene), "");
        arguments.camera = scene.camera;
        arguments.time = scene.seconds;
        arguments.shutter = game::makeShutterArguments(scene.exposureSeconds, scene.phase);
        arguments.size = {240, 136};
        mOptions = game::interpret(arguments).value();
        mShot.emplace(game::loadShot(mOptions).value());
    }

    render::FrameResult draw(RevealTraversal traversal, uint32_t recursionLimit) {
        game::MethodOptions method = game::makeMethod(*game::findMethod("hybrid").value());
        method.motionBlur.revealTraversal = traversal;
        method.motionBlur.recursionLimit = recursionLimit;
        render::Renderer renderer(device(), mShot->world.assets);
        game::PictureRequest picture =
            game::makePicture(*mShot, mOptions, method, GetParam().seconds);
        picture.frame.intermediates = {"mask", "mesh_id", "reveal", "reveal_motion", "reveal_id"};
        auto frame = game::PictureDrawer(device(), renderer).draw(mShot->world, picture);
        EXPECT_TRUE(frame.ok());
        return std::move(frame).value();
    }

    game::ShotOptions mOptions;
    std::optional<game::Shot> mShot;
};

double relativeError(float a, float b, float least) {
    return std::abs(a - b) / std::max({std::abs(a), std::abs(b), least});
}

TEST_P(RevealOfScenes, OneTraversalFindsWhatSteppingFinds) {
    const auto single = draw(RevealTraversal::Single, 1); // its limit means nothing
    const auto& found = single.intermediates;
    ASSERT_TRUE(found.contains("mask")) << "nothing moves in sight";
    for (const uint32_t limit : {5u, 64u}) {
        const auto stepping = draw(RevealTraversal::Stepping, limit);
        const auto& views = stepping.intermediates;
        const image::Image& mask = views.at("mask");
        size_t masked = 0;
        size_t stopped = 0;
        size_t otherObject = 0;
        double worstColor = 0.0; // relative to the larger, or to 0.1 where both are darker
        double worstDepth = 0.0; // relative
        for (uint32_t y = 0; y < mask.height; ++y)
            for (uint32_t x = 0; x < mask.width; ++x) {
                if (mask.at(x, y, 0) < 0.5f)
                    continue;
                ++masked;
                const auto differ = [&](const char* view, uint32_t c, float least) {
                    return relativeError(
                        found.at(view).at(x, y, c), views.at(view).at(x, y, c), least
                    );
                };
                const float front = views.at("mesh_id").at(x, y, 0);
                const float id = found.at("reveal_id").at(x, y, 0);
                const float stepped = views.at("reveal_id").at(x, y, 0);
                if (stepped == front && id != front) {
                    ++stopped; // at its limit; the other finds the background that lies deeper
                    continue;
                }
                otherObject += id != stepped;
                for (uint32_t c = 0; c < 3; ++c)
                    worstColor = std::max(worstColor, differ("reveal", c, 0.1f));
                worstDepth = std::max(worstDepth, differ("reveal_motion", 2, 1.0e-6f));
            }
        EXPECT_TRUE(GetParam().name != "vase" || masked > 200) << masked;
        EXPECT_EQ(otherObject, 0u);
        // A step that is not the first starts at another place of the ray: the hit moves by
        // rounding.
        EXPECT_LE(worstColor, 1.0 / 256);
        EXPECT_LE(worstDepth, 1.0e-5);
        // None of these scenes' objects has more surfaces than the second limit.
        EXPECT_TRUE(limit == 5u || stopped == 0u) << stopped;
    }
    const auto& counters = single.statistics.counters;
    EXPECT_LE(counters.at("rays traced"), counters.at("pixels masked"));
}

INSTANTIATE_TEST_SUITE_P(
    Scenes,
    RevealOfScenes,
    testing::ValuesIn(listScenes()),
    [](const auto& param) { return param.param.name; }
);

constexpr double kHalfPx = 14.0; // the mover covers 34 <= x < 62 and 18 <= y < 46

Shot maskShot(motion_blur::MaskTest test = motion_blur::MaskTest::Paper) {
    Shot shot{.method = "hybrid", .aovs = {"mask", "edge"}};
    shot.settings = motion_blur::paperSettings();
    shot.settings.maskTest = test;
    return shot;
}

/// A mover `gap` metres before a wall that fills the picture.
void addMaskMover(SceneBuilder& scene, double gap, double speedPx, double wallSpeedPx = 0.0) {
    scene.setPixelView(64);
    test::addCard(
        scene, {200, 200}, {0, 1, 0}, {.position = {0, 0, -20}, .velocity = {wallSpeedPx, 0, 0}}
    );
    test::addCard(
        scene,
        {2 * kHalfPx, 2 * kHalfPx},
        {1, 0, 0},
        {.position = {0, 0, -20 + gap}, .velocity = {speedPx, 0, 0}}
    );
}

size_t countMasked(gpu::Device& device, const SceneBuilder& scene, const Shot& shot) {
    const auto result = test::renderOnce(device, scene, shot);
    return test::countSet(result.intermediates.at("mask"));
}

TEST_F(RevealLaw, TheSameMeshIdIsNotMasked) {
    // Both move alike: only the paper's mask, which has no uniform motion, tests them.
    Shot shot = maskShot();
    shot.settings.uniformMotionPx = 0.0f;
    // Mover and wall are one entity: the same picture, the same depths, the same motion.
    SceneBuilder scene = test::makePixelView(64);
    const auto wall = test::transformed(
        test::makeQuad(200, 200, scene.addColor({0, 1, 0})),
        glm::translate(math::dmat4(1.0), dvec3(0, 0, -5))
    );
    const auto front = test::makeQuad(28, 28, scene.addColor({1, 0, 0}));
    const auto mesh = scene.addMesh({wall, front});
    scene.add(mesh, {.position = {0, 0, -15}, .velocity = {12, 0, 0}});
    const auto result = test::renderOnce(device(), scene, shot);
    EXPECT_EQ(test::countSet(result.intermediates.at("mask")), 0u);
    // As two entities that move alike, the mask is there: only the id differs.
    SceneBuilder two;
    addMaskMover(two, 5.0, 12.0, 12.0);
    EXPECT_GT(countMasked(device(), two, shot), 200u);
}

TEST_F(RevealLaw, OnlyEdgesAreMaskedWhoseDepthsDifferByMoreThanTheExtentThatGrowsWithTheDepth) {
    SceneBuilder scene;
    addMaskMover(scene, 5.0, 12.0); // 15 m before the camera
    Stage stage(device(), scene);
    const auto countWith = [&](float extent, float share, float edgeThreshold) {
        Shot shot = maskShot();
        shot.settings.softDepthExtent = extent;
        shot.settings.softDepthShare = share;
        shot.settings.edgeThreshold = edgeThreshold;
        return test::countSet(stage.render(shot).intermediates.at("mask"));
    };
    const Shot paper = maskShot();
    const float threshold = paper.settings.edgeThreshold;
    EXPECT_EQ(countWith(5.01f, 0.0f, threshold), 0u);
    EXPECT_GT(countWith(4.99f, 0.0f, threshold), 200u);
    EXPECT_EQ(countWith(2.0f, 3.01f / 15.0f, threshold), 0u);
    EXPECT_GT(countWith(2.0f, 2.99f / 15.0f, threshold), 200u);
    EXPECT_GT(countWith(0.0f, 0.0f, threshold), 200u) << "an extent of 0 divides";
    // Depth step and normals as they are, the edge's measure is x / (x + 1) below 1; a threshold
    // of 1 is out of its reach, and one below it is not.
    const float extent = paper.settings.softDepthExtent;
    const float share = paper.settings.softDepthShare;
    EXPECT_EQ(countWith(extent, share, 1.0f), 0u);
    EXPECT_GT(countWith(extent, share, 0.9f), 200u);
}

TEST_F(RevealLaw, RelativeMasksAMoverBeforeAStillWallAsThePaperDoesAndNothingWhereAllMovesAlike) {
    for (const double wallSpeedPx : {0.0, 12.0}) {
        SceneBuilder scene;
        addMaskMover(scene, 5.0, 12.0, wallSpeedPx);
        const auto draw = [&](motion_blur::MaskTest test) {
            Shot shot = maskShot(test);
            shot.settings.uniformMotionPx = 0.0f;
            return test::renderOnce(device(), scene, shot).intermediates.at("mask");
        };
        const image::Image relative = draw(motion_blur::MaskTest::Relative);
        const image::Image paper = draw(motion_blur::MaskTest::Paper);
        EXPECT_GT(test::countSet(paper), 200u);
        if (wallSpeedPx == 0.0)
            EXPECT_TRUE(test::sameBits(relative, paper));
        else
            EXPECT_EQ(test::countSet(relative), 0u);
    }
}

TEST_F(RevealLaw, RelativeMasksNoPixelOfTheWallThatMovesBehind) {
    SceneBuilder scene;
    addMaskMover(scene, 5.0, 12.0, 5.0);
    const auto countOutside = [&](motion_blur::MaskTest test) {
        const auto result = test::renderOnce(device(), scene, maskShot(test));
        const image::Image& mask = result.intermediates.at("mask");
        size_t inside = 0;
        size_t outside = 0;
        for (uint32_t y = 0; y < mask.height; ++y)
            for (uint32_t x = 0; x < mask.width; ++x)
                if (mask.at(x, y, 0) > 0.5f)
                    ++(x >= 34 && x < 62 && y >= 18 && y < 46 ? inside : outside);
        EXPECT_GT(inside, 100u);
        return outside;
    };
    EXPECT_GT(countOutside(motion_blur::MaskTest::Paper), 50u);
    EXPECT_EQ(countOutside(motion_blur::MaskTest::Relative), 0u);
}

TEST_F(RevealLaw, TheEdgeMeasureFollowsTheDepthStep) {
    // A vertical step of D metres: the derivative (1 2 0 -2 -1) times the smoothing (1 4 6 4 1)
    // gives 16 * 3 D next to the step, 16 * D one pixel further out. Normals are equal.
    const double gap = 0.05;
    SceneBuilder scene;
    addMaskMover(scene, gap, 12.0);
    Shot shot = maskShot();
    shot.settings.edgeThreshold = 0.6f; // between 0.8 / 1.8 and 2.4 / 3.4
    const auto result = test::renderOnce(device(), scene, shot);
    const image::Image& edge = result.intermediates.at("edge");
    const auto measureOf = [&](double factor) {
        const double x = factor * 16.0 * gap;
        return x / (x + 1.0);
    };
    // RGBA8: half a step of 1/255, and one for the float depths of 15 m and 20 m (1e-6 m * 48).
    EXPECT_NEAR(edge.at(61, 32, 1), measureOf(3.0), 1.0 / 255.0);
    EXPECT_NEAR(edge.at(62, 32, 1), measureOf(3.0), 1.0 / 255.0);
    EXPECT_NEAR(edge.at(60, 32, 1), measureOf(1.0), 1.0 / 255.0);
    EXPECT_NEAR(edge.at(59, 32, 1), 0.0, 1.0 / 255.0);
    // The mover's own pixels are candidates, and one of them passes the threshold.
    EXPECT_EQ(edge.at(61, 32, 2), 1.0f);
    EXPECT_EQ(edge.at(60, 32, 2), 0.0f);
    EXPECT_EQ(edge.at(62, 32, 2), 0.0f) << "the wall does not move";
}

/// Masked pixels in the row through the mover's middle, as first and one past the last; they must
/// be without a gap.
std::pair<uint32_t, uint32_t> maskedSpan(const image::Image& mask, uint32_t firstX, uint32_t endX) {
    uint32_t first = endX;
    uint32_t end = firstX;
    uint32_t count = 0;
    for (uint32_t x = firstX; x < endX; ++x)
        if (mask.at(x, 32, 0) > 0.5f) {
            first = std::min(first, x);
            end = x + 1;
            ++count;
        }
    EXPECT_EQ(count, end - std::min(first, end)) << "the range check stepped over the edge";
    return {first, end};
}

TEST_F(RevealLaw, TheRangeCheckReachesAsFarAsTheMotionButNoFartherThanTheTile) {
    // Edge pixels are the two nearest the silhouette; all that are within a motion of them are
    // masked. With the phase at the start, the mover leaves its trailing side (34) during the
    // exposure; with the phase at the end, it came to its leading side (62).
    for (const auto& [speedPx, tilePx, reachPx] :
         {std::tuple{4.0, 40u, 4.0}, {8.0, 40u, 8.0}, {13.0, 40u, 13.0}, {60.0, 10u, 10.0}}) {
        SceneBuilder scene;
        addMaskMover(scene, 5.0, speedPx);
        Stage stage(device(), scene);
        Shot shot = maskShot();
        shot.settings.tileSizePx = tilePx;
        // The mover has its place at time 0 in both.
        shot.phase = scene::ShutterPhase::Start;
        const auto start = stage.render(shot);
        const auto [first, end] = maskedSpan(start.intermediates.at("mask"), 34, 62);
        EXPECT_EQ(first, 34u) << speedPx;
        EXPECT_NEAR(end, 36.0 + reachPx, 1.0) << speedPx;
        shot.phase = scene::ShutterPhase::End;
        const auto atEnd = stage.render(shot);
        const auto [firstAtEnd, endAtEnd] = maskedSpan(atEnd.intermediates.at("mask"), 34, 62);
        EXPECT_NEAR(firstAtEnd, 60.0 - reachPx, 1.0) << speedPx;
        EXPECT_EQ(endAtEnd, 62u) << speedPx;
    }
}

TEST_F(RevealLaw, AStillObjectIsNeverMasked) {
    SceneBuilder scene;
    addMaskMover(scene, 5.0, 12.0);
    test::addCard(scene, {10, 60}, {0, 0, 1}, {.position = {-38, 0, -10}});
    const auto result = test::renderOnce(device(), scene, maskShot());
    const image::Image& mask = result.intermediates.at("mask");
    for (uint32_t y = 0; y < 64; ++y)
        for (uint32_t x = 0; x < 34; ++x)
            ASSERT_EQ(mask.at(x, y, 0), 0.0f) << x << ", " << y;
}

constexpr math::vec3 kBackground(0.2f, 0.3f, 0.4f);
/// One step of an 8-bit display; blending in half floats stays far below.
constexpr double kStep = 1.0 / 255.0;

scene::AssetIndex addLeaves(SceneBuilder& scene) {
    const scene::AssetIndex leaves = scene.addWaves(true);
    scene.world.assets.textures.back().nearest = true; // a hole's border is one place for everyone
    return leaves;
}

SceneBuilder makeWall() {
    SceneBuilder scene = test::makeView();
    scene.add(
        test::makeQuad(5, 4, scene.addWaves()),
        {.position = {0, 0, -4}, .rotation = glm::angleAxis(0.3, dvec3(0, 1, 0))}
    );
    return scene;
}

void addSquare(SceneBuilder& scene, const dvec3& velocity) {
    test::addCard(
        scene, {0.9, 0.9}, {1, 0, 0.9f}, {.position = {0.05, -0.03, -2}, .velocity = velocity}
    );
}

void addMover(SceneBuilder& scene) {
    addSquare(scene, {0.35, 0.1, 0});
}

/// Passes near surfaces faster than far ones.
void moveCamera(SceneBuilder& scene) {
    scene.moveCamera({.velocity = {-0.7, -0.2, 0}});
}

/// A pane in front of the mover and one behind it; the last entities, so that no other id changes.
void addPanes(SceneBuilder& scene, const dvec3& velocity = dvec3(0.0)) {
    scene.add(
        test::makeQuad(1.2, 0.5, test::addGlass(scene, {0.1f, 0.3f, 0.9f, 0.4f})),
        {.position = {0, 0, -1.5}, .velocity = velocity}
    );
    scene.add(
        test::makeQuad(2, 1, test::addGlass(scene, {0.2f, 0.9f, 0.1f, 0.7f})),
        {.position = {0.1, 0.4, -3}, .velocity = velocity}
    );
}

Shot paneShotOf(std::string_view method) {
    return {.method = method, .background = kBackground};
}

TEST_F(RevealLaw, BlendedSurfacesLeaveTheIntermediatesOfWhatLiesBehind) {
    SceneBuilder without = makeWall();
    addMover(without);
    SceneBuilder with = makeWall();
    addMover(with);
    addPanes(with, {0.5, 0, 0});
    Shot shot = paneShotOf("hybrid");
    shot.aovs = {"motion", "depth", "normal", "mesh_id", "edge", "mask"};
    const auto expected = test::renderOnce(device(), without, shot);
    const auto actual = test::renderOnce(device(), with, shot);
    EXPECT_FALSE(test::sameBits(expected.color, actual.color)) << "no pane is in the picture";
    EXPECT_GT(test::countSet(expected.intermediates.at("mask")), 150u);
    for (const std::string& name : shot.aovs)
        EXPECT_TRUE(test::sameBits(expected.intermediates.at(name), actual.intermediates.at(name)))
            << name;
}

/// Opaque, masked and blended parts of one mesh, which rays for blended layers meet as a whole.
void addPanedMover(SceneBuilder& scene) {
    const auto at = [](scene::Primitive primitive, double z) {
        return test::transformed(
            std::move(primitive), glm::translate(math::dmat4(1.0), dvec3(0, 0, z))
        );
    };
    const auto pane = test::makeQuad(0.9, 0.5, test::addGlass(scene, {0.9f, 0.9f, 0.1f, 0.5f}));
    const auto leaves = at(test::makeQuad(0.9, 0.9, addLeaves(scene)), -0.1);
    const auto back = at(test::makeQuad(0.9, 0.9, scene.addColor({1, 0, 0.9f})), -0.2);
    scene.add(scene.addMesh({pane, leaves, back}), {.position = {0.05, -0.03, -1.8}});
}

TEST_F(RevealLaw, SurfacesAndTheSkyAreRevealedWithoutThePanesThatTheLayerDraws) {
    const auto addWall = [](SceneBuilder& scene) { scene = makeWall(); };
    const auto addSolid = [](SceneBuilder& scene) {
        addPanes(scene);
        addSquare(scene, dvec3(0.0));
        moveCamera(scene);
    };
    const auto addPaned = [](SceneBuilder& scene) {
        addPanes(scene);
        addPanedMover(scene);
        moveCamera(scene);
    };
    RevealCase cases[] = {
        {"a wall", addWall, addSolid},
        {"the sky", [](SceneBuilder&) {}, addSolid},
        {"a mover with panes", addWall, addPaned}};
    for (RevealCase& law : cases) {
        law.backgroundMoves = true;
        expectRevealIsRaster(device(), law);
    }
}

TEST_F(RevealLaw, PanesAreSortedWhateverTheirOrderInTheTable) {
    const vec4 colors[] = {
        {0.9f, 0.1f, 0.1f, 0.5f}, {0.1f, 0.9f, 0.1f, 0.5f}, {0.1f, 0.1f, 0.9f, 0.5f}};
    const auto render = [&](bool nearFirst, std::string_view method) {
        SceneBuilder scene = makeWall();
        for (int i = 0; i < 3; ++i) {
            const int layer = nearFirst ? i : 2 - i;
            scene.add(
                test::makeQuad(1.5, 1.5, test::addGlass(scene, colors[layer], true)),
                {.position = {0.2 * layer, 0, -1.5 - 0.5 * layer}}
            );
        }
        Shot shot = paneShotOf(method);
        shot.exposureSeconds = 0.0;
        shot.instants = 1;
        return test::renderOnce(device(), scene, shot).color;
    };
    const image::Image nearFirst = render(true, "sharp");
    EXPECT_TRUE(test::sameBits(nearFirst, render(false, "sharp")));
    EXPECT_LE(image::computeMaxDifference(nearFirst, render(true, "truth")), kStep);
}

TEST_F(RevealLaw, AMaskCoversTheSamePixelsInRasterMotionAndRays) {
    SceneBuilder scene = makeWall();
    scene.add(
        test::makeQuad(3, 3, addLeaves(scene)),
        {.position = {0.03, 0.02, -2}, .velocity = {0.4, 0, 0}}
    );
    Shot shot = paneShotOf("sharp");
    shot.aovs = {"motion", "mesh_id"};
    const auto raster = test::renderOnce(device(), scene, shot);
    // Motion and id are the leaves' or the wall's, together.
    size_t covered = 0;
    size_t open = 0;
    const image::Image& ids = raster.intermediates.at("mesh_id");
    const image::Image& motion = raster.intermediates.at("motion");
    for (uint32_t y = 0; y < ids.height; ++y)
        for (uint32_t x = 0; x < ids.width; ++x) {
            const bool isLeaf = ids.at(x, y, 0) == 1.0f;
            ASSERT_EQ(isLeaf, motion.at(x, y, 0) > 1.0f) << x << ' ' << y;
            ++(isLeaf ? covered : open);
        }
    EXPECT_GT(covered, 1000u);
    EXPECT_GT(open, 1000u);
    // A ray through the same pixel at the same instant meets the same.
    Shot still = paneShotOf("truth");
    still.exposureSeconds = 0.0;
    still.instants = 1;
    const auto rays = test::renderOnce(device(), scene, still);
    EXPECT_LE(image::computeMaxDifference(rays.color, raster.color), kStep);
}

} // namespace
} // namespace shutter
