// SPDX-License-Identifier: MIT
// The three tests of the ray mask, each taken away in turn, and how far the range check reaches;
// the table of alpha modes in modules/motion_blur/limits.md, cell by cell.
#include "tests/support/gpu_fixture.h"
#include "tests/support/picture.h"
#include "tests/support/stage.h"

#include <algorithm>
#include <string>
#include <utility>

namespace shutter {
namespace {

using math::dvec3;
using math::vec4;
using test::SceneBuilder;
using test::Shot;
using test::Stage;

class MaskLaw : public test::RayTest {};

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
    scene.add(
        test::makeQuad(200, 200, scene.addColor({0, 1, 0})),
        {.position = {0, 0, -20}, .velocity = {wallSpeedPx, 0, 0}}
    );
    scene.add(
        test::makeQuad(2 * kHalfPx, 2 * kHalfPx, scene.addColor({1, 0, 0})),
        {.position = {0, 0, -20 + gap}, .velocity = {speedPx, 0, 0}}
    );
}

size_t countMasked(gpu::Device& device, const SceneBuilder& scene, const Shot& shot) {
    const auto result = test::renderOnce(device, scene, shot);
    return test::countSet(result.intermediates.at("mask"));
}

TEST_F(MaskLaw, TheSameMeshIdIsNotMasked) {
    // Both move alike: only the paper's mask, which has no uniform motion, tests them.
    Shot shot = maskShot();
    shot.settings.uniformMotionPx = 0.0f;
    // Mover and wall are one entity: the same picture, the same depths, the same motion.
    SceneBuilder scene;
    scene.setPixelView(64);
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

TEST_F(MaskLaw, ADepthDifferenceBelowTheSoftExtentIsNotMasked) {
    SceneBuilder scene;
    addMaskMover(scene, 5.0, 12.0);
    Shot shot = maskShot();
    shot.settings.softDepthShare = 0.0f;
    shot.settings.softDepthExtent = 5.01f;
    EXPECT_EQ(countMasked(device(), scene, shot), 0u);
    shot.settings.softDepthExtent = 4.99f;
    EXPECT_GT(countMasked(device(), scene, shot), 200u);
}

TEST_F(MaskLaw, TheSoftExtentGrowsWithTheDepthByItsShare) {
    SceneBuilder scene;
    addMaskMover(scene, 5.0, 12.0); // 15 m before the camera
    Shot shot = maskShot();
    shot.settings.softDepthExtent = 2.0f;
    shot.settings.softDepthShare = 3.01f / 15.0f;
    EXPECT_EQ(countMasked(device(), scene, shot), 0u);
    shot.settings.softDepthShare = 2.99f / 15.0f;
    EXPECT_GT(countMasked(device(), scene, shot), 200u);
    shot.settings.softDepthExtent = shot.settings.softDepthShare = 0.0f;
    EXPECT_GT(countMasked(device(), scene, shot), 200u) << "an extent of 0 divides";
}

TEST_F(MaskLaw, RelativeMasksAMoverBeforeAStillWallAsThePaperDoesAndNothingWhereAllMovesAlike) {
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

TEST_F(MaskLaw, RelativeMasksNoPixelOfTheWallThatMovesBehind) {
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

TEST_F(MaskLaw, NoEdgeMeansNoMask) {
    // Depth step and normals as they are, the measure is x / (x + 1) below 1; a threshold of 1 is
    // out of its reach, and one below it is not.
    SceneBuilder scene;
    addMaskMover(scene, 5.0, 12.0);
    Shot shot = maskShot();
    shot.settings.edgeThreshold = 1.0f;
    EXPECT_EQ(countMasked(device(), scene, shot), 0u);
    shot.settings.edgeThreshold = 0.9f;
    EXPECT_GT(countMasked(device(), scene, shot), 200u);
}

TEST_F(MaskLaw, TheEdgeMeasureFollowsTheDepthStep) {
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

TEST_F(MaskLaw, TheRangeCheckReachesAsFarAsTheMotion) {
    // Edge pixels are the two nearest the silhouette; all that are within a motion of them are
    // masked. With the phase at the start, the mover leaves its trailing side (34) during the
    // exposure; with the phase at the end, it came to its leading side (62).
    for (double speedPx : {4.0, 8.0, 13.0}) {
        SceneBuilder scene;
        addMaskMover(scene, 5.0, speedPx);
        Stage stage(device(), scene);
        Shot shot = maskShot();
        // The mover has its place at time 0 in both.
        shot.phase = scene::ShutterPhase::Start;
        const auto start = stage.render(shot);
        const auto [first, end] = maskedSpan(start.intermediates.at("mask"), 34, 62);
        EXPECT_EQ(first, 34u) << speedPx;
        EXPECT_NEAR(end, 36.0 + speedPx, 1.0) << speedPx;
        shot.phase = scene::ShutterPhase::End;
        const auto atEnd = stage.render(shot);
        const auto [firstAtEnd, endAtEnd] = maskedSpan(atEnd.intermediates.at("mask"), 34, 62);
        EXPECT_NEAR(firstAtEnd, 60.0 - speedPx, 1.0) << speedPx;
        EXPECT_EQ(endAtEnd, 62u) << speedPx;
    }
}

TEST_F(MaskLaw, TheRangeCheckIsClampedToTheTile) {
    SceneBuilder scene;
    addMaskMover(scene, 5.0, 60.0);
    Shot shot = maskShot();
    shot.phase = scene::ShutterPhase::Start;
    shot.settings.tileSizePx = 10;
    const auto result = test::renderOnce(device(), scene, shot);
    const auto [first, end] = maskedSpan(result.intermediates.at("mask"), 34, 62);
    EXPECT_EQ(first, 34u);
    EXPECT_NEAR(end, 46.0, 1.0);
}

TEST_F(MaskLaw, AStillObjectIsNeverMasked) {
    SceneBuilder scene;
    addMaskMover(scene, 5.0, 12.0);
    scene.add(test::makeQuad(10, 60, scene.addColor({0, 0, 1})), {.position = {-38, 0, -10}});
    const auto result = test::renderOnce(device(), scene, maskShot());
    const image::Image& mask = result.intermediates.at("mask");
    for (uint32_t y = 0; y < 64; ++y)
        for (uint32_t x = 0; x < 34; ++x)
            ASSERT_EQ(mask.at(x, y, 0), 0.0f) << x << ", " << y;
}

class TransparencyLaw : public test::RayTest {};

constexpr math::vec3 kBackground(0.2f, 0.3f, 0.4f);
/// One step of an 8-bit display; blending in half floats stays far below.
constexpr double kStep = 1.0 / 255.0;

scene::AssetIndex addGlass(SceneBuilder& scene, const vec4& color, bool doubleSided = false) {
    scene::Material glass;
    glass.unlit = true;
    glass.alphaMode = scene::AlphaMode::Blend;
    glass.baseColorFactor = color;
    glass.doubleSided = doubleSided;
    return scene.addMaterial(glass);
}

scene::AssetIndex addLeaves(SceneBuilder& scene) {
    scene::Material leaves;
    leaves.unlit = true;
    leaves.alphaMode = scene::AlphaMode::Mask;
    leaves.baseColor.texture = scene.addWaveTexture(64, true);
    scene.world.assets.textures.back().nearest = true; // a hole's border is one place for everyone
    return scene.addMaterial(leaves);
}

SceneBuilder makeWall() {
    SceneBuilder scene;
    scene.setPerspective(0.9);
    scene.add(
        test::makeQuad(5, 4, scene.addWaves()),
        {.position = {0, 0, -4}, .rotation = glm::angleAxis(0.3, dvec3(0, 1, 0))}
    );
    return scene;
}

void addSquare(SceneBuilder& scene, const dvec3& velocity) {
    scene.add(
        test::makeQuad(0.9, 0.9, scene.addColor({1, 0, 0.9f})),
        {.position = {0.05, -0.03, -2}, .velocity = velocity}
    );
}

void addMover(SceneBuilder& scene) {
    addSquare(scene, {0.35, 0.1, 0});
}

/// Passes near surfaces faster than far ones; panes stay in the raster.
void moveCamera(SceneBuilder& scene) {
    scene.moveCamera({.velocity = {-0.7, -0.2, 0}});
}

/// A pane in front of the mover and one behind it; the last entities, so that no other id changes.
void addPanes(SceneBuilder& scene, const dvec3& velocity = dvec3(0.0)) {
    scene.add(
        test::makeQuad(1.2, 0.5, addGlass(scene, {0.1f, 0.3f, 0.9f, 0.4f})),
        {.position = {0, 0, -1.5}, .velocity = velocity}
    );
    scene.add(
        test::makeQuad(2, 1, addGlass(scene, {0.2f, 0.9f, 0.1f, 0.7f})),
        {.position = {0.1, 0.4, -3}, .velocity = velocity}
    );
}

Shot shotOf(std::string_view method) {
    return {.method = method, .background = kBackground};
}

auto isSet(const image::Image& mask) {
    return [&mask](uint32_t x, uint32_t y) { return mask.at(x, y, 0) > 0.5f; };
}

/// Inside the mask, where `with` shows surfaces that `without` lacks, the revealed layer equals the
/// raster of `without`. \return the mask, of these pixels alone
image::Image
expectRevealed(gpu::Device& device, const SceneBuilder& with, const SceneBuilder& without) {
    const auto expected = test::renderOnce(device, without, shotOf("sharp"));
    Shot shot = shotOf("hybrid");
    shot.aovs = {"mask", "reveal"};
    auto actual = test::renderOnce(device, with, shot);
    const image::Image shown = test::renderOnce(device, with, shotOf("sharp")).color;
    image::Image& mask = actual.intermediates.at("mask");
    for (uint32_t y = 0; y < mask.height; ++y)
        for (uint32_t x = 0; x < mask.width; ++x) {
            bool differs = false;
            for (uint32_t channel = 0; channel < 3; ++channel)
                differs = differs || shown.at(x, y, channel) != expected.color.at(x, y, channel);
            if (!differs)
                mask.at(x, y, 0) = 0.0f;
        }
    EXPECT_GT(test::countSet(mask), 150u);
    EXPECT_LE(
        test::computeMaxDifferenceWhere(
            actual.intermediates.at("reveal"), expected.color, isSet(mask)
        ),
        kStep
    );
    return std::move(actual.intermediates.at("mask"));
}

TEST_F(TransparencyLaw, BlendedSurfacesLeaveTheIntermediatesOfWhatLiesBehind) {
    SceneBuilder without = makeWall();
    addMover(without);
    SceneBuilder with = makeWall();
    addMover(with);
    addPanes(with, {0.5, 0, 0});
    Shot shot = shotOf("hybrid");
    shot.aovs = {"motion", "depth", "normal", "mesh_id", "edge", "mask"};
    const auto expected = test::renderOnce(device(), without, shot);
    const auto actual = test::renderOnce(device(), with, shot);
    EXPECT_FALSE(test::sameBits(expected.color, actual.color)) << "no pane is in the picture";
    EXPECT_GT(test::countSet(expected.intermediates.at("mask")), 150u);
    for (const std::string& name : shot.aovs)
        EXPECT_TRUE(test::sameBits(expected.intermediates.at(name), actual.intermediates.at(name)))
            << name;
}

TEST_F(TransparencyLaw, RevealedSurfacesAreSeenThroughBlendedOnes) {
    SceneBuilder without = makeWall();
    addPanes(without);
    SceneBuilder with = makeWall();
    addPanes(with);
    addSquare(with, dvec3(0.0));
    moveCamera(with);
    const image::Image mask = expectRevealed(device(), with, without);
    // The law is void without a pane in front of the revealed surface.
    const auto panes = test::renderOnce(device(), without, shotOf("sharp"));
    const auto none = test::renderOnce(device(), makeWall(), shotOf("sharp"));
    EXPECT_GT(test::computeMaxDifferenceWhere(none.color, panes.color, isSet(mask)), 0.2);
}

TEST_F(TransparencyLaw, TheSkyIsRevealedThroughBlendedSurfacesToo) {
    const auto addSky = [](SceneBuilder& scene) {
        scene.setPerspective(0.9);
        addPanes(scene);
    };
    SceneBuilder without;
    addSky(without);
    SceneBuilder with;
    addSky(with);
    addSquare(with, dvec3(0.0));
    moveCamera(with);
    expectRevealed(device(), with, without);
}

TEST_F(TransparencyLaw, AMoverGoesWithItsOwnPanesAndItsSolidPartsAreNoLayers) {
    // The rays for blended layers meet the mover's mesh as a whole: opaque, masked and blended
    // parts.
    SceneBuilder without = makeWall();
    addPanes(without);
    SceneBuilder with = makeWall();
    addPanes(with);
    const auto at = [](scene::Primitive primitive, double z) {
        return test::transformed(
            std::move(primitive), glm::translate(math::dmat4(1.0), dvec3(0, 0, z))
        );
    };
    const auto pane = test::makeQuad(0.9, 0.5, addGlass(with, {0.9f, 0.9f, 0.1f, 0.5f}));
    const auto leaves = at(test::makeQuad(0.9, 0.9, addLeaves(with)), -0.1);
    const auto back = at(test::makeQuad(0.9, 0.9, with.addColor({1, 0, 0.9f})), -0.2);
    with.add(with.addMesh({pane, leaves, back}), {.position = {0.05, -0.03, -1.8}});
    moveCamera(with);
    expectRevealed(device(), with, without);
}

TEST_F(TransparencyLaw, PanesAreSortedWhateverTheirOrderInTheTable) {
    const vec4 colors[] = {
        {0.9f, 0.1f, 0.1f, 0.5f}, {0.1f, 0.9f, 0.1f, 0.5f}, {0.1f, 0.1f, 0.9f, 0.5f}};
    const auto render = [&](bool nearFirst, std::string_view method) {
        SceneBuilder scene = makeWall();
        for (int i = 0; i < 3; ++i) {
            const int layer = nearFirst ? i : 2 - i;
            scene.add(
                test::makeQuad(1.5, 1.5, addGlass(scene, colors[layer], true)),
                {.position = {0.2 * layer, 0, -1.5 - 0.5 * layer}}
            );
        }
        Shot shot = shotOf(method);
        shot.exposureSeconds = 0.0;
        shot.instants = 1;
        return test::renderOnce(device(), scene, shot).color;
    };
    const image::Image nearFirst = render(true, "sharp");
    EXPECT_TRUE(test::sameBits(nearFirst, render(false, "sharp")));
    const auto everywhere = [](uint32_t, uint32_t) { return true; };
    EXPECT_LE(test::computeMaxDifferenceWhere(nearFirst, render(true, "truth"), everywhere), kStep);
}

TEST_F(TransparencyLaw, AMaskCoversTheSamePixelsInRasterMotionAndRays) {
    SceneBuilder scene = makeWall();
    scene.add(
        test::makeQuad(3, 3, addLeaves(scene)),
        {.position = {0.03, 0.02, -2}, .velocity = {0.4, 0, 0}}
    );
    Shot shot = shotOf("sharp");
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
    Shot still = shotOf("truth");
    still.exposureSeconds = 0.0;
    still.instants = 1;
    const auto rays = test::renderOnce(device(), scene, still);
    EXPECT_LE(
        test::computeMaxDifferenceWhere(
            rays.color, raster.color, [](uint32_t, uint32_t) { return true; }
        ),
        kStep
    );
}

} // namespace
} // namespace shutter
