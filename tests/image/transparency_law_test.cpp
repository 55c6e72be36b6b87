// SPDX-License-Identifier: MIT
// The table of alpha modes in docs/limits.md, cell by cell.
#include "modules/motion_blur/methods.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/picture.h"
#include "tests/support/stage.h"

#include <string>
#include <utility>

namespace shutter {
namespace {

using math::dvec3;
using math::vec4;
using test::SceneBuilder;
using test::Shot;

class TransparencyLaw : public test::GpuTest {
  protected:
    void SetUp() override {
        GpuTest::SetUp();
        if (!device().hasRayQuery())
            GTEST_SKIP() << device().info().name << " has no ray queries";
    }
};

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

SceneBuilder makeScene() {
    SceneBuilder scene;
    scene.setPerspective(0.9);
    scene.add(
        test::makeQuad(5, 4, scene.addTextured(scene.addWaveTexture())),
        {.position = {0, 0, -4}, .rotation = glm::angleAxis(0.3, dvec3(0, 1, 0))}
    );
    return scene;
}

void addMover(SceneBuilder& scene) {
    scene.add(
        test::makeQuad(0.9, 0.9, scene.addColor({1, 0, 0.9f})),
        {.position = {0.05, -0.03, -2}, .velocity = {0.35, 0.1, 0}}
    );
}

/// A pane before the mover and one behind it; the last entities, so that no other id changes.
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

/// Inside the mask, what is revealed in `with` is what raster draws of `without`.
/// \return the mask
image::Image
expectRevealed(gpu::Device& device, const SceneBuilder& with, const SceneBuilder& without) {
    const auto expected = test::renderOnce(device, without, shotOf("sharp"));
    Shot shot = shotOf("hybrid");
    shot.aovs = {"mask", "reveal"};
    auto actual = test::renderOnce(device, with, shot);
    const image::Image& mask = actual.intermediates.at("mask");
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
    SceneBuilder without = makeScene();
    addMover(without);
    SceneBuilder with = makeScene();
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

TEST_F(TransparencyLaw, WhatIsRevealedIsSeenThroughTheBlendedSurfacesBeforeIt) {
    SceneBuilder without = makeScene();
    addPanes(without);
    SceneBuilder with = makeScene();
    addPanes(with);
    addMover(with);
    const image::Image mask = expectRevealed(device(), with, without);
    // The law means nothing where no pane is before what is revealed.
    const auto panes = test::renderOnce(device(), without, shotOf("sharp"));
    const auto none = test::renderOnce(device(), makeScene(), shotOf("sharp"));
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
    addMover(with);
    expectRevealed(device(), with, without);
}

TEST_F(TransparencyLaw, AMoverGoesWithItsOwnPanesAndItsSolidPartsAreNoLayers) {
    // The rays for blended layers meet the mover's mesh as a whole: opaque, masked and blended
    // parts.
    SceneBuilder without = makeScene();
    addPanes(without);
    SceneBuilder with = makeScene();
    addPanes(with);
    const auto at = [](scene::Primitive primitive, double z) {
        return test::transformed(
            std::move(primitive), glm::translate(math::dmat4(1.0), dvec3(0, 0, z))
        );
    };
    const auto pane = test::makeQuad(0.9, 0.5, addGlass(with, {0.9f, 0.9f, 0.1f, 0.5f}));
    const auto leaves = at(test::makeQuad(0.9, 0.9, addLeaves(with)), -0.1);
    const auto back = at(test::makeQuad(0.9, 0.9, with.addColor({1, 0, 0.9f})), -0.2);
    with.add(
        with.addMesh({pane, leaves, back}),
        {.position = {0.05, -0.03, -1.8}, .velocity = {0.35, 0.1, 0}}
    );
    expectRevealed(device(), with, without);
}

TEST_F(TransparencyLaw, AMovingPaneBeforeAStillWallStaysSharp) {
    SceneBuilder scene = makeScene();
    addPanes(scene, {0.5, 0.2, 0});
    const auto sharp = test::renderOnce(device(), scene, shotOf("sharp"));
    for (const std::string_view method : test::listBlurMethods(device())) {
        // What traces the whole picture sees the pane at each instant, and blurs it.
        const bool isTraced = !motion_blur::getMethod(method).readsRaster;
        EXPECT_NE(
            isTraced,
            test::sameBits(sharp.color, test::renderOnce(device(), scene, shotOf(method)).color)
        ) << method;
    }
}

TEST_F(TransparencyLaw, PanesAreSortedWhateverTheirOrderInTheTable) {
    const vec4 colors[] = {
        {0.9f, 0.1f, 0.1f, 0.5f}, {0.1f, 0.9f, 0.1f, 0.5f}, {0.1f, 0.1f, 0.9f, 0.5f}};
    const auto render = [&](bool nearFirst, std::string_view method) {
        SceneBuilder scene = makeScene();
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
    SceneBuilder scene = makeScene();
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
