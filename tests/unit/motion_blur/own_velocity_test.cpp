// SPDX-License-Identifier: MIT
#include "shaders/motion_blur/own_velocity.glsl"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace shutter::shader {

namespace {

/// Bevy's comparison for a centred exposure: half the sample's motion, projected on the step, is no
/// shorter than the step.
bool couldCoverByBevy(vec2 step, vec2 motion) {
    const double distance = std::hypot(double(step.x), double(step.y));
    const double speed = std::hypot(double(motion.x), double(motion.y)) / 2.0;
    const double dotted = double(step.x) * motion.x + double(step.y) * motion.y;
    const double similarity = std::min(std::abs(dotted / (distance * speed * 2.0)), 1.0);
    return speed * similarity >= distance;
}

} // namespace

TEST(OwnVelocity, TheOccluderTestIsBevysInACentredExposure) {
    int covering = 0;
    for (int step = 1; step < 12; ++step)
        for (int x = -25; x <= 25; x += 3)
            for (int y = -25; y <= 25; y += 3) {
                const vec2 offset(float(step), 0.37f * float(step));
                const vec2 motion(float(x) + 0.25f, float(y) + 0.5f);
                const bool covers = couldCover(offset, motion, 0.5f);
                EXPECT_EQ(covers, couldCoverByBevy(offset, motion)) << step << " " << x << " " << y;
                covering += covers;
            }
    EXPECT_GT(covering, 100);
}

TEST(OwnVelocity, AStillOccluderCoversNothingButItself) {
    EXPECT_FALSE(couldCover(vec2(0.5f, 0.0f), vec2(0.0f), 0.5f));
    EXPECT_TRUE(couldCover(vec2(0.0f), vec2(0.0f), 0.5f));
}

TEST(OwnVelocity, InAOneSidedExposureTheSideCounts) {
    // Ends at the raster instant: only what moves towards the offset has come from over the pixel.
    EXPECT_TRUE(couldCover(vec2(8.0f, 0.0f), vec2(9.0f, 0.0f), 1.0f));
    EXPECT_FALSE(couldCover(vec2(8.0f, 0.0f), vec2(-9.0f, 0.0f), 1.0f));
    EXPECT_FALSE(couldCover(vec2(8.0f, 0.0f), vec2(9.0f, 0.0f), 0.0f));
    EXPECT_TRUE(couldCover(vec2(8.0f, 0.0f), vec2(-9.0f, 0.0f), 0.0f));
}

} // namespace shutter::shader
