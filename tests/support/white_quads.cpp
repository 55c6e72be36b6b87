// SPDX-License-Identifier: MIT
#include "tests/support/white_quads.h"

#include "tests/kit/scene_builder.h"
#include "tests/support/picture.h"

#include <gtest/gtest.h>

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

} // namespace shutter::test
