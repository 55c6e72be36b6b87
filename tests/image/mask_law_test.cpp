// SPDX-License-Identifier: MIT
// The three tests of the ray mask, each taken away in turn, and how far the range check reaches.
#include "tests/support/gpu_fixture.h"
#include "tests/support/picture.h"
#include "tests/support/stage.h"

#include <algorithm>
#include <utility>

namespace shutter {
namespace {

using math::dvec3;
using test::SceneBuilder;
using test::Shot;
using test::Stage;

class MaskLaw : public test::GpuTest {};

constexpr double kHalfPx = 14.0; // the mover covers 34 <= x < 62 and 18 <= y < 46

Shot maskShot(motion_blur::MaskTest test = motion_blur::MaskTest::Paper) {
    Shot shot{.method = "hybrid", .aovs = {"mask", "edge"}};
    shot.settings = motion_blur::paperSettings();
    shot.settings.maskTest = test;
    return shot;
}

/// A mover `gap` metres before a wall that fills the picture.
void addMover(SceneBuilder& scene, double gap, double speedPx, double wallSpeedPx = 0.0) {
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

TEST_F(MaskLaw, AMoverBeforeAWallIsMasked) {
    SceneBuilder scene;
    addMover(scene, 5.0, 12.0);
    EXPECT_GT(countMasked(device(), scene, maskShot()), 200u);
}

TEST_F(MaskLaw, TheSameMeshIdIsNotMasked) {
    // Both move alike: only the paper's mask, which has no uniform motion, looks at them.
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
    two.setPixelView(64);
    two.add(
        test::makeQuad(200, 200, two.addColor({0, 1, 0})),
        {.position = {0, 0, -20}, .velocity = {12, 0, 0}}
    );
    two.add(
        test::makeQuad(28, 28, two.addColor({1, 0, 0})),
        {.position = {0, 0, -15}, .velocity = {12, 0, 0}}
    );
    EXPECT_GT(countMasked(device(), two, shot), 200u);
}

TEST_F(MaskLaw, ADepthDifferenceBelowTheSoftExtentIsNotMasked) {
    SceneBuilder scene;
    addMover(scene, 5.0, 12.0);
    Shot shot = maskShot();
    shot.settings.softDepthShare = 0.0f;
    shot.settings.softDepthExtent = 5.01f;
    EXPECT_EQ(countMasked(device(), scene, shot), 0u);
    shot.settings.softDepthExtent = 4.99f;
    EXPECT_GT(countMasked(device(), scene, shot), 200u);
}

TEST_F(MaskLaw, TheSoftExtentGrowsWithTheDepthByItsShare) {
    SceneBuilder scene;
    addMover(scene, 5.0, 12.0); // 15 m before the camera
    Shot shot = maskShot();
    shot.settings.softDepthExtent = 2.0f;
    shot.settings.softDepthShare = 3.01f / 15.0f;
    EXPECT_EQ(countMasked(device(), scene, shot), 0u);
    shot.settings.softDepthShare = 2.99f / 15.0f;
    EXPECT_GT(countMasked(device(), scene, shot), 200u);
    shot.settings.softDepthExtent = shot.settings.softDepthShare = 0.0f;
    EXPECT_GT(countMasked(device(), scene, shot), 200u) << "an extent of 0 divides";
}

TEST_F(MaskLaw, RelativeMasksAMoverBeforeAStillWallAsThePaperDoes) {
    SceneBuilder scene;
    addMover(scene, 5.0, 12.0);
    const auto mask = [&](motion_blur::MaskTest test) {
        return test::renderOnce(device(), scene, maskShot(test)).intermediates.at("mask");
    };
    EXPECT_TRUE(
        test::sameBits(mask(motion_blur::MaskTest::Relative), mask(motion_blur::MaskTest::Paper))
    );
}

TEST_F(MaskLaw, RelativeMasksNothingWhereAllMovesAlike) {
    SceneBuilder scene;
    addMover(scene, 5.0, 12.0, 12.0);
    const auto count = [&](motion_blur::MaskTest test) {
        Shot shot = maskShot(test);
        shot.settings.uniformMotionPx = 0.0f;
        return countMasked(device(), scene, shot);
    };
    EXPECT_GT(count(motion_blur::MaskTest::Paper), 200u);
    EXPECT_EQ(count(motion_blur::MaskTest::Relative), 0u);
}

TEST_F(MaskLaw, RelativeMasksNoPixelOfTheWallThatMovesBehind) {
    SceneBuilder scene;
    addMover(scene, 5.0, 12.0, 5.0);
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
    addMover(scene, 5.0, 12.0);
    Shot shot = maskShot();
    shot.settings.edgeThreshold = 1.0f;
    EXPECT_EQ(countMasked(device(), scene, shot), 0u);
    shot.settings.edgeThreshold = 0.9f;
    EXPECT_GT(countMasked(device(), scene, shot), 200u);
}

TEST_F(MaskLaw, TheEdgeMeasureFollowsTheDepthStep) {
    // A vertical step of D metres: the derivative (1 2 0 -2 -1) times the smoothing (1 4 6 4 1)
    // gives 16 * 3 D beside the step, 16 * D one pixel further out. Normals are equal.
    const double gap = 0.05;
    SceneBuilder scene;
    addMover(scene, gap, 12.0);
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
        addMover(scene, 5.0, speedPx);
        Stage stage(device(), scene);
        Shot shot = maskShot();
        // The mover stands where it does at time 0 in both.
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
    addMover(scene, 5.0, 60.0);
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
    addMover(scene, 5.0, 12.0);
    scene.add(test::makeQuad(10, 60, scene.addColor({0, 0, 1})), {.position = {-38, 0, -10}});
    const auto result = test::renderOnce(device(), scene, maskShot());
    const image::Image& mask = result.intermediates.at("mask");
    for (uint32_t y = 0; y < 64; ++y)
        for (uint32_t x = 0; x < 34; ++x)
            ASSERT_EQ(mask.at(x, y, 0), 0.0f) << x << ", " << y;
}

} // namespace
} // namespace shutter
