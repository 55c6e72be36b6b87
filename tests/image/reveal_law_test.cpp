// SPDX-License-Identifier: MIT
// What rays reveal behind a mover is what raster draws when the mover is not there.
#include "tests/support/gpu_fixture.h"
#include "tests/support/picture.h"
#include "tests/support/stage.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace shutter {
namespace {

using math::dvec3;
using scene::Material;
using test::Placement;
using test::SceneBuilder;
using test::Shot;
using test::Stage;

class RevealLaw : public test::GpuTest {};

using AddToScene = std::function<void(SceneBuilder&)>;

Shot revealShot() {
    return {
        .method = "hybrid",
        .background = math::vec3(0.2f, 0.3f, 0.4f),
        .aovs = {"mask", "reveal", "mesh_id"}};
}

/// Renders `background` with and without `occluder`; inside the mask the revealed colour of the
/// first must be the raster of the second to 1/255.
/// \param leastMasked pixels that must be in the mask for the test to mean anything
void expectRevealIsRaster(
    gpu::Device& device,
    const AddToScene& background,
    const AddToScene& occluder,
    Shot shot = revealShot(),
    size_t leastMasked = 150
) {
    SceneBuilder alone;
    background(alone);
    SceneBuilder both;
    background(both);
    occluder(both);
    Shot sharp = shot;
    sharp.method = "sharp";
    const auto expected = test::renderOnce(device, alone, sharp);
    const auto result = test::renderOnce(device, both, shot);
    ASSERT_TRUE(result.intermediates.contains("mask"));
    const image::Image& mask = result.intermediates.at("mask");
    const image::Image& reveal = result.intermediates.at("reveal");
    EXPECT_GT(test::countSet(mask), leastMasked);
    const auto masked = [&](uint32_t x, uint32_t y) { return mask.at(x, y, 0) > 0.5f; };
    EXPECT_LE(test::computeMaxDifferenceWhere(reveal, expected.color, masked), 1.0 / 255.0);
    // The law means nothing where the occluder looks like what it hides.
    Shot front = sharp;
    const auto hidden = test::renderOnce(device, both, front);
    EXPECT_GT(test::computeMaxDifferenceWhere(hidden.color, expected.color, masked), 0.2);
}

void addOccluder(SceneBuilder& scene) {
    scene.add(
        test::makeQuad(0.9, 0.9, scene.addColor({1, 0, 0.9f})),
        {.position = {0.05, -0.03, -2}, .velocity = {0.35, 0.1, 0}}
    );
}

void setCamera(SceneBuilder& scene) {
    scene.setPerspective(0.9);
}

Placement wall() {
    return {
        .position = {0, 0, -4},
        .rotation = glm::angleAxis(0.4, glm::normalize(dvec3(0.3, 1.0, 0.0)))};
}

TEST_F(RevealLaw, MorePixelsAreRevealedThanOneRowOfGroupsHolds) {
    // A row is 256 groups of 64 pixels.
    Shot shot = revealShot();
    shot.width = 960;
    shot.height = 720;
    const auto background = [](SceneBuilder& scene) {
        setCamera(scene);
        scene.add(test::makeQuad(9.0, 9.0, scene.addTextured(scene.addWaveTexture())), wall());
    };
    expectRevealIsRaster(device(), background, addOccluder, shot, 256 * 64 + 64);
}

TEST_F(RevealLaw, ATexturedWallIsRevealedAsRasterDrawsIt) {
    expectRevealIsRaster(
        device(),
        [](SceneBuilder& scene) {
            setCamera(scene);
            scene.add(test::makeQuad(5, 4, scene.addTextured(scene.addWaveTexture())), wall());
        },
        addOccluder
    );
}

TEST_F(RevealLaw, ItHoldsInEveryPhase) {
    for (auto phase : {scene::ShutterPhase::Start, scene::ShutterPhase::End}) {
        Shot shot = revealShot();
        shot.phase = phase;
        expectRevealIsRaster(
            device(),
            [](SceneBuilder& scene) {
                setCamera(scene);
                scene.add(test::makeQuad(5, 4, scene.addTextured(scene.addWaveTexture())), wall());
            },
            addOccluder,
            shot
        );
    }
}

TEST_F(RevealLaw, ItHoldsUnderAnOrthographicCamera) {
    expectRevealIsRaster(
        device(),
        [](SceneBuilder& scene) {
            scene.setPixelView(64);
            Placement placement = wall();
            placement.position = {0, 0, -50};
            scene.add(
                test::makeQuad(110, 90, scene.addTextured(scene.addWaveTexture())), placement
            );
        },
        [](SceneBuilder& scene) {
            scene.add(
                test::makeQuad(30, 30, scene.addColor({1, 0, 0.9f})),
                {.position = {1.3, 0.4, -5}, .velocity = {11, 4, 0}}
            );
        }
    );
}

TEST_F(RevealLaw, AMirroredBackgroundShowsTheSideThatRasterShows) {
    // Single-sided and scaled by -1: the back of a wall behind must not come through, nor its own
    // front be lost.
    expectRevealIsRaster(
        device(),
        [](SceneBuilder& scene) {
            setCamera(scene);
            const auto waves = scene.addTextured(scene.addWaveTexture());
            scene.add(
                test::makeBox({1.6, 1.6, 0.6}, waves),
                {.position = {0, 0, -4},
                 .rotation = glm::angleAxis(0.4, dvec3(0, 1, 0)),
                 .scale = {-1.5, 1, 1}}
            );
            scene.add(test::makeQuad(9, 7, scene.addColor({0, 0.5f, 0})), {.position = {0, 0, -6}});
        },
        addOccluder
    );
}

TEST_F(RevealLaw, AMirroredQuadThatTurnsItsBackIsPassed) {
    // z scaled by -1 keeps the corners but turns the winding: raster culls it, rays must too.
    expectRevealIsRaster(
        device(),
        [](SceneBuilder& scene) {
            setCamera(scene);
            const auto waves = scene.addTextured(scene.addWaveTexture());
            scene.add(
                test::makeQuad(5, 4, scene.addColor({1, 1, 0})),
                {.position = {0, 0, -3}, .scale = {-1, -1, -1}}
            );
            scene.add(test::makeQuad(5, 4, waves), wall());
        },
        addOccluder
    );
}

TEST_F(RevealLaw, HolesOfAnAlphaMaskShowWhatLiesBehindThem) {
    expectRevealIsRaster(
        device(),
        [](SceneBuilder& scene) {
            setCamera(scene);
            Material leaves;
            leaves.unlit = true;
            leaves.alphaMode = scene::AlphaMode::Mask;
            leaves.baseColor.texture = scene.addWaveTexture(64, true);
            // Level 0 of its texture (nearest, below one texel a pixel): the hole's border is where
            // both say it is.
            scene.world.assets.textures.back().nearest = true;
            scene.add(
                test::makeQuad(9, 9, scene.addMaterial(leaves)), {.position = {0.03, 0.02, -3}}
            );
            scene.add(test::makeQuad(5, 4, scene.addTextured(scene.addWaveTexture())), wall());
        },
        addOccluder
    );
}

TEST_F(RevealLaw, ADoubleSidedWallShowsItsBack) {
    expectRevealIsRaster(
        device(),
        [](SceneBuilder& scene) {
            setCamera(scene);
            scene.add(
                test::makeQuad(5, 4, scene.addTextured(scene.addWaveTexture(), true)),
                {.position = {0, 0, -4}, .rotation = glm::angleAxis(2.8, dvec3(0, 1, 0))}
            );
        },
        addOccluder
    );
}

TEST_F(RevealLaw, ATextureTransformIsTheSame) {
    expectRevealIsRaster(
        device(),
        [](SceneBuilder& scene) {
            setCamera(scene);
            Material material;
            material.unlit = true;
            material.baseColor = {scene.addWaveTexture(), 0, {0.3f, -0.2f}, 0.7f, {2.5f, 1.3f}};
            scene.add(test::makeQuad(5, 4, scene.addMaterial(material)), wall());
        },
        addOccluder
    );
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

void addWall(SceneBuilder& scene) {
    setCamera(scene);
    scene.add(test::makeQuad(5, 4, scene.addTextured(scene.addWaveTexture())), wall());
}

TEST_F(RevealLaw, AConcaveOccluderIsPassedWithEnoughLevels) {
    Shot shot = revealShot();
    shot.settings.revealTraversal = motion_blur::RevealTraversal::Stepping;
    shot.settings.recursionLimit = 5; // four surfaces of its own, then the wall
    expectRevealIsRaster(device(), addWall, addPronged, shot);
}

TEST_F(RevealLaw, TooFewLevelsEndInsideAConcaveOccluder) {
    SceneBuilder scene;
    addWall(scene);
    addPronged(scene);
    Shot shot = revealShot();
    shot.settings.revealTraversal = motion_blur::RevealTraversal::Stepping;
    shot.settings.recursionLimit = 3;
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

TEST_F(RevealLaw, OneTraversalFindsTheBackgroundWhereTooFewLevelsDoNot) {
    Shot shot = revealShot();
    shot.settings.recursionLimit = 1; // of stepping alone
    expectRevealIsRaster(device(), addWall, addPronged, shot);
}

TEST_F(RevealLaw, OneTraversalPassesMoversWithoutMasksOfTheirOwn) {
    // More movers than masks, all behind the camera and larger than the one in front: that one is
    // passed candidate by candidate.
    const auto addCrowd = [](SceneBuilder& scene) {
        addWall(scene);
        const auto color = scene.addColor({0, 1, 0});
        for (int i = 0; i < 40; ++i)
            scene.add(
                test::makeQuad(9, 9, color),
                {.position = {0, 0, 2.0 + 0.01 * i}, .velocity = {0.1, 0, 0}}
            );
    };
    expectRevealIsRaster(device(), addCrowd, addPronged);
}

TEST_F(RevealLaw, SingleAndDoubleSidedPartsOfOneMeshKeepTheirSides) {
    expectRevealIsRaster(
        device(),
        [](SceneBuilder& scene) {
            setCamera(scene);
            const auto texture = scene.addWaveTexture();
            const auto single = scene.addTextured(texture);
            const auto both = scene.addTextured(texture, true);
            const auto yellow = scene.addColor({1, 1, 0});
            const auto around = glm::rotate(math::dmat4(1.0), 3.0, dvec3(0, 1, 0));
            const auto at = [](const dvec3& place) {
                return glm::translate(math::dmat4(1.0), place);
            };
            // From the front: a single-sided part that turns its back, then, side by side, the back
            // of a double-sided part and the front of a single-sided one.
            scene.add(
                scene.addMesh(
                    {test::transformed(test::makeQuad(4, 4, yellow), at({0, 0, 1}) * around),
                     test::transformed(test::makeQuad(2, 4, both), at({-1, 0, 0}) * around),
                     test::transformed(test::makeQuad(2, 4, single), at({1, 0, -0.2}))}
                ),
                {.position = {0, 0, -4}}
            );
        },
        addOccluder
    );
}

TEST_F(RevealLaw, TheLuminanceTestFindsAnObjectOfAnotherLuminance) {
    Shot shot = revealShot();
    shot.settings.objectTest = motion_blur::ObjectTest::Luminance;
    expectRevealIsRaster(
        device(),
        [](SceneBuilder& scene) {
            setCamera(scene);
            scene.add(test::makeQuad(5, 4, scene.addTextured(scene.addWaveTexture())), wall());
        },
        [](SceneBuilder& scene) {
            // Luminance 1; the waves stay below 0.9.
            const auto white = scene.addColor({1, 1, 1});
            scene.add(
                test::makeBox({0.9, 0.9, 0.2}, white),
                {.position = {0.05, -0.03, -2}, .velocity = {0.35, 0.1, 0}}
            );
        },
        shot
    );
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
    SceneBuilder scene;
    occluders(scene);
    SceneBuilder alone;
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

TEST_F(RevealLaw, BeforeTheSkyOnlyTheBackgroundColourIsRevealed) {
    SceneBuilder scene;
    setCamera(scene);
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

} // namespace
} // namespace shutter
