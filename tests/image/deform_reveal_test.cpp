// SPDX-License-Identifier: MIT
// Rays at the raster instant meet deformed meshes where raster draws them, with the motion that
// raster tells.
#include "tests/support/deformed_meshes.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/picture.h"
#include "tests/support/stage.h"

#include <array>
#include <functional>

namespace shutter {
namespace {

using math::dvec3;
using test::Placement;
using test::SceneBuilder;
using test::Shot;

class DeformReveal : public test::GpuTest {
  protected:
    void SetUp() override {
        GpuTest::SetUp();
        if (!IsSkipped() && !HasFatalFailure() && !device().hasRays())
            GTEST_SKIP() << device().info().name << " has no ray queries";
    }
};

constexpr float kOccluderRow = 1.0f; // of the entity table

using AddToScene = std::function<void(SceneBuilder&)>;

/// What the occluder's pixels in the mask reveal, colour and motion, is what raster draws without
/// the occluder. The background comes first, so that rows agree. \param leastMotionPx of the
/// background, somewhere
void expectRevealIsRaster(
    gpu::Device& device,
    const AddToScene& background,
    const AddToScene& occluder,
    double leastMotionPx
) {
    SceneBuilder alone;
    alone.setPerspective(0.9);
    background(alone);
    SceneBuilder both;
    both.setPerspective(0.9);
    background(both);
    occluder(both);
    Shot shot{
        .method = "hybrid",
        .background = math::vec3(0.2f, 0.3f, 0.4f),
        .aovs = {"mask", "reveal", "reveal_motion", "motion", "mesh_id"}};
    const auto result = test::renderOnce(device, both, shot);
    shot.method = "sharp";
    const auto expected = test::renderOnce(device, alone, shot);
    const image::Image& mask = result.intermediates.at("mask");
    const image::Image& ids = result.intermediates.at("mesh_id");
    const auto masked = [&](uint32_t x, uint32_t y) {
        return mask.at(x, y, 0) > 0.5f && ids.at(x, y, 0) == kOccluderRow;
    };
    const image::Image& reveal = result.intermediates.at("reveal");
    EXPECT_LE(test::computeMaxDifferenceWhere(reveal, expected.color, masked), 1.0 / 255.0);
    const image::Image& motion = expected.intermediates.at("motion");
    const image::Image& revealed = result.intermediates.at("reveal_motion");
    double longest = 0.0;
    size_t compared = 0;
    for (uint32_t y = 0; y < mask.height; ++y)
        for (uint32_t x = 0; x < mask.width; ++x) {
            if (!masked(x, y))
                continue;
            ++compared;
            for (uint32_t c = 0; c < 2; ++c) {
                ASSERT_NEAR(revealed.at(x, y, c), motion.at(x, y, c), 0.02) << x << ", " << y;
                longest = std::max(longest, std::abs(double(motion.at(x, y, c))));
            }
        }
    EXPECT_GE(longest, leastMotionPx);
    EXPECT_GT(compared, 100u) << "too few pixels to mean anything";
}

void addOccluder(SceneBuilder& scene) {
    scene.add(
        test::makeQuad(0.9, 0.9, scene.addColor({1, 0, 0.9f})),
        {.position = {0.05, -0.03, -2}, .velocity = {0.35, 0.1, 0}}
    );
}

/// A wall of 6 m that bends back and forth.
void addDeformedWall(SceneBuilder& scene, bool doubleSided, const dvec3& scale) {
    const std::array joints{
        Placement{.position = {0, -3, -4}, .scale = scale, .angularVelocity = {0, 0.1, 0}},
        Placement{.position = {0, 3, 0}, .angularVelocity = {0.2, 0.1, 0.3}}};
    const scene::AssetIndex material = scene.addTextured(scene.addWaveTexture(), doubleSided);
    test::addSkinned(scene, test::makeStrip(7.0, 6.0, 10, material), joints);
}

TEST_F(DeformReveal, ADeformedWallIsRevealedAsRasterDrawsIt) {
    expectRevealIsRaster(
        device(),
        [](SceneBuilder& scene) { addDeformedWall(scene, false, dvec3(1)); },
        addOccluder,
        2.0
    );
}

TEST_F(DeformReveal, AMirroredSingleSidedWallKeepsItsFront) {
    expectRevealIsRaster(
        device(),
        [](SceneBuilder& scene) { addDeformedWall(scene, false, dvec3(-1, 1, 1)); },
        addOccluder,
        2.0
    );
}

TEST_F(DeformReveal, AMorphingWallIsRevealedAsRasterDrawsIt) {
    expectRevealIsRaster(
        device(),
        [](SceneBuilder& scene) {
            scene::Primitive wall =
                test::makeStrip(7.0, 6.0, 10, scene.addTextured(scene.addWaveTexture()));
            scene::MorphTarget& target = wall.morphTargets.emplace_back();
            for (const math::vec3& position : wall.positions)
                target.positions.push_back({0.3f * position.y, 0.0f, 0.2f * position.x});
            const Placement placement{.position = {0, -3, -4}, .angularVelocity = {0, 0.1, 0}};
            test::addMorphed(scene, wall, placement, {{0.0f}, {1.0f}});
        },
        addOccluder,
        2.0
    );
}

TEST_F(DeformReveal, BehindADeformedMeshTheWallIsRevealed) {
    expectRevealIsRaster(
        device(),
        [](SceneBuilder& scene) {
            scene.add(
                test::makeQuad(7, 6, scene.addTextured(scene.addWaveTexture())),
                {.position = {0, 0, -4}}
            );
        },
        [](SceneBuilder& scene) {
            const std::array joints{
                Placement{.position = {-0.1, -0.5, -2}, .velocity = {0.35, 0, 0}},
                Placement{.position = {0, 0.5, 0}, .angularVelocity = {0, 0, 0.8}}};
            test::addSkinned(
                scene, test::makeStrip(0.7, 1.0, 10, scene.addColor({1, 0, 0.9f})), joints
            );
        },
        0.0
    );
}

} // namespace
} // namespace shutter
