// SPDX-License-Identifier: MIT
#include "tests/support/white_quads.h"

#include "tests/kit/scene_builder.h"
#include "tests/support/picture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace shutter::test {

namespace {

/// Positions are measured in pictures so many times finer.
constexpr uint32_t kFiner = 8;

math::dvec2 measurePosition(Stage& stage, Shot shot, double instant) {
    shot.method = "sharp";
    shot.instant = instant;
    shot.width *= kFiner;
    shot.height *= kFiner;
    shot.aovs.clear();
    return computeCentroid(stage.render(shot).color) / double(kFiner);
}

/// Between the four pixels around a place.
math::dvec2 sampleMotion(const image::Image& motion, const math::dvec2& px) {
    const math::dvec2 at = px - 0.5;
    const auto x = static_cast<uint32_t>(std::floor(at.x));
    const auto y = static_cast<uint32_t>(std::floor(at.y));
    const math::dvec2 share = at - glm::floor(at);
    const auto read = [&](uint32_t column, uint32_t row) {
        return math::dvec2(motion.at(column, row, 0), motion.at(column, row, 1));
    };
    const math::dvec2 above = glm::mix(read(x, y), read(x + 1, y), share.x);
    const math::dvec2 below = glm::mix(read(x, y + 1), read(x + 1, y + 1), share.x);
    return glm::mix(above, below, share.y);
}

} // namespace

ecs::Entity addMarker(SceneBuilder& scene, double sizeMetres, const Placement& placement) {
    const math::dmat4 tilt = glm::rotate(math::dmat4(1.0), 0.3, math::dvec3(0.0, 0.0, 1.0));
    return scene.add(
        transformed(makeQuad(sizeMetres, sizeMetres, scene.addColor({1, 1, 1})), tilt), placement
    );
}

void expectMotionOfMarker(Stage& stage, Shot shot, double longerThanPx) {
    shot.method = "sharp";
    shot.aovs = {"motion", "mesh_id"};
    const double rasterTime =
        scene::computeExposure({shot.exposureSeconds, shot.phase}, shot.seconds).rasterTime;
    const math::dvec2 middle = measurePosition(stage, shot, rasterTime);
    const math::dvec2 moved = measurePosition(stage, shot, 1.0) - measurePosition(stage, shot, 0.0);
    ASSERT_TRUE(middle.x > 1.0 && middle.x < shot.width - 1.0) << middle.x;
    ASSERT_TRUE(middle.y > 1.0 && middle.y < shot.height - 1.0) << middle.y;
    const math::dvec2 motion = sampleMotion(stage.render(shot).intermediates.at("motion"), middle);
    EXPECT_NEAR(motion.x, moved.x, 0.05);
    EXPECT_NEAR(motion.y, moved.y, 0.05);
    EXPECT_GE(glm::length(moved), longerThanPx);
}

void expectTrapezoidInEachPhase(
    gpu::Device& device, std::string_view method, uint32_t samples, double tolerance
) {
    // A white quad w pixels wide, seen over [a, a + w] at open and moved by m to the right: pixel
    // centre x is covered for the share of s in [0, 1] with a + m s <= x <= a + m s + w.
    constexpr double kWidth = 20.3;
    constexpr double kMotion = 31.7;
    SceneBuilder scene;
    scene.setPixelView(8);
    scene.add(
        makeQuad(kWidth, 20, scene.addColor({1, 1, 1})),
        {.position = {0.4, 0, -10}, .velocity = {kMotion, 0, 0}}
    );
    Stage stage(device, scene);
    for (auto phase :
         {scene::ShutterPhase::Start, scene::ShutterPhase::Centre, scene::ShutterPhase::End}) {
        const auto interval = scene::computeExposure({1.0, phase}, 0.0);
        const double left = 48.0 + 0.4 + kMotion * interval.open - kWidth / 2.0;
        const auto result =
            stage.render({.method = method, .height = 8, .phase = phase, .instants = samples});
        double highest = 0.0;
        for (uint32_t x = 0; x < 96; ++x) {
            const double enters = (x + 0.5 - left - kWidth) / kMotion;
            const double leaves = (x + 0.5 - left) / kMotion;
            const double covered = std::clamp(leaves, 0.0, 1.0) - std::clamp(enters, 0.0, 1.0);
            ASSERT_NEAR(result.color.at(x, 4, 1), covered, tolerance)
                << x << " phase " << int(phase);
            highest = std::max(highest, covered);
        }
        EXPECT_NEAR(highest, kWidth / kMotion, 1e-9) << "the trapezoid's top is in the picture";
    }
}

} // namespace shutter::test
