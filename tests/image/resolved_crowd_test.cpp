// SPDX-License-Identifier: MIT
// Tiles that see more entities than a list holds: no farther from the truth than the filters
// without lists, and the same bits in every run and for entities in any order.
#include "engine/image/metrics.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/picture.h"
#include "tests/support/stage.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace shutter {
namespace {

using math::dvec3;

class ResolvedCrowd : public test::GpuTest {
  protected:
    static constexpr uint32_t kWidth = 96;
    static constexpr uint32_t kHeight = 64;
    static constexpr uint64_t kTiles = (kWidth / 16) * (kHeight / 16);

    static test::Shot shotOf(std::string_view method) {
        test::Shot shot{
            .method = method,
            .width = kWidth,
            .height = kHeight,
            .exposureSeconds = 1.0 / 48.0,
            .phase = scene::ShutterPhase::End,
            .frameSeconds = 1.0 / 24.0,
            .instants = 256};
        shot.settings.sampleCount = motion_blur::getMethod("own_velocity").defaultSamples;
        if (method == "resolved" || method == "adaptive" || method == "gather")
            shot.settings.sampleCount = 15;
        return shot;
    }

    struct Crowd {
        int count = 1500;
        double sidePx = 3.5;          ///< of each, at a middle depth
        dvec3 together{0.0};          ///< m/s, of all
        double apart = 0.0;           ///< m/s at most, of each in a direction of its own
        bool hasWall = true;          ///< behind them
        test::Placement camera{};     ///< of the picture
        bool isReversed = false;      ///< the entities are made in reverse order
        dvec3 from{-3.2, -2.2, -5.5}; ///< where they are
        dvec3 to{3.2, 2.2, -3.5};
    };

    static test::SceneBuilder makeCrowd(const Crowd& crowd) {
        test::SceneBuilder scene;
        scene.setPerspective(0.9);
        scene.moveCamera(crowd.camera);
        if (crowd.hasWall)
            scene.add(
                test::makeQuad(16, 12, scene.addTextured(scene.addWaveTexture(), true)),
                {.position = {0, 0, -6}}
            );
        // A pixel at the depth of -4.5 m.
        const double side = crowd.sidePx * 4.5 * 2.0 * std::tan(0.45) / kHeight;
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
        std::vector<test::Placement> placements;
        for (int i = 0; i < crowd.count; ++i) {
            test::Placement one;
            for (int axis = 0; axis < 3; ++axis)
                one.position[axis] = crowd.from[axis] + unit() * (crowd.to - crowd.from)[axis];
            const double angle = unit() * 2.0 * 3.14159265358979;
            const double speed = crowd.apart * std::sqrt(unit());
            one.velocity = crowd.together + speed * dvec3(std::cos(angle), std::sin(angle), 0.0);
            placements.push_back(one);
        }
        std::vector<size_t> order(placements.size());
        for (size_t i = 0; i < order.size(); ++i)
            order[i] = crowd.isReversed ? order.size() - 1 - i : i;
        for (const size_t i : order)
            scene.add(meshes[i % meshes.size()], placements[i]);
        return scene;
    }

    static uint64_t countCrowded(const render::FrameResult& drawn) {
        return drawn.statistics.counters.at("crowded tiles");
    }

    struct Compared {
        double resolved = 0.0; ///< PSNR against the truth, dB
        double filters = 0.0;  ///< the better of own_velocity and gather
        uint64_t crowded = 0;  ///< tiles
    };

    Compared compare(const test::SceneBuilder& scene, const test::Shot& wanted) {
        const auto truth = test::renderOnce(device(), scene, shotOf("accumulate"));
        const auto drawn = test::renderOnce(device(), scene, wanted);
        const auto psnrOf = [&](const render::FrameResult& frame) {
            return image::computePsnr(frame.color, truth.color);
        };
        return {
            psnrOf(drawn),
            std::max(
                psnrOf(test::renderOnce(device(), scene, shotOf("own_velocity"))),
                psnrOf(test::renderOnce(device(), scene, shotOf("gather")))
            ),
            countCrowded(drawn)};
    }

    Compared compare(const Crowd& crowd) { return compare(makeCrowd(crowd), shotOf("resolved")); }
};

TEST_F(ResolvedCrowd, ThatMovesAsOneIsNearerToTheTruthThanTheFilters) {
    const Compared compared = compare({.together = {8.0, 2.0, 0.0}});
    EXPECT_GT(compared.crowded, kTiles / 2);
    EXPECT_GT(compared.resolved, compared.filters + 1.0);
}

TEST_F(ResolvedCrowd, WhoseMembersGoTheirOwnWaysIsNearerToTheTruthThanTheFilters) {
    const Compared compared = compare({.apart = 10.0});
    EXPECT_GT(compared.crowded, kTiles / 2);
    EXPECT_GT(compared.resolved, compared.filters + 1.0);
}

TEST_F(ResolvedCrowd, ThatStandsStillBeforeAMovingCameraIsNearerToTheTruthThanTheFilters) {
    const Compared turning = compare({.camera = {.angularVelocity = {0.2, 1.5, 0.3}}});
    EXPECT_GT(turning.crowded, kTiles / 2);
    EXPECT_GT(turning.resolved, turning.filters + 1.0);
    const Compared going = compare({.camera = {.velocity = {8.0, 0.0, -8.0}}});
    EXPECT_GT(going.crowded, kTiles / 2);
    EXPECT_GT(going.resolved, going.filters + 1.0);
}

} // namespace
} // namespace shutter
