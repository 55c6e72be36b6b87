// SPDX-License-Identifier: MIT
// Paths of what turns, from the slope of its motion, against rotations about a known point.
#include "shaders/motion_blur/motion_arc.glsl"

#include <glm/glm.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace shutter::shader {
namespace {

using glm::dmat2;
using glm::dvec2;

/// What turns about a point, seen from the side or not, in pixels.
struct Turn {
    double degrees = 0.0; ///< over the exposure
    double aspect = 1.0;  ///< height of the ellipses to their width
    double growth = 1.0;  ///< over the exposure

    /// What a share of the exposure does to places, relative to the point.
    [[nodiscard]] dmat2 by(double share) const {
        const double angle = degrees * std::numbers::pi / 180.0 * share;
        const dmat2 turned(std::cos(angle), std::sin(angle), -std::sin(angle), std::cos(angle));
        const dmat2 flat(1.0, 0.0, 0.0, aspect);
        return flat * turned * glm::inverse(flat) * std::pow(growth, share);
    }

    [[nodiscard]] Arc arcAt(dvec2 place, double rasterTime) const {
        const dmat2 slope = by(1.0 - rasterTime) - by(-rasterTime);
        return makeArc(vec2(slope * place), vec2(slope[0]), vec2(slope[1]), float(rasterTime));
    }
};

bool isStraight(const Arc& arc) {
    return arc.power[1] == vec2(0.0f) && arc.power[2] == vec2(0.0f);
}

TEST(MotionArc, WhatTurnsGoesRoundAnEllipseWhateverTheRasterTime) {
    const dvec2 place(90.0, -40.0);
    for (const Turn& turn :
         {Turn{5.0},
          Turn{20.0},
          Turn{45.0},
          Turn{65.0},
          Turn{-65.0},
          Turn{40.0, 0.6},
          Turn{40.0, 1.6},
          Turn{30.0, 1.0, 1.2},
          Turn{30.0, 0.7, 0.8}})
        for (const double rasterTime : {0.0, 0.3, 0.5, 1.0}) {
            const Arc arc = turn.arcAt(place, rasterTime);
            EXPECT_FALSE(isStraight(arc)) << turn.degrees;
            for (int i = 0; i <= 8; ++i) {
                const double u = rasterTime - i / 8.0;
                const dvec2 expected = turn.by(u) * place - place;
                EXPECT_LT(glm::distance(dvec2(placeOnArc(arc, float(u))), expected), 0.15)
                    << turn.degrees << " degrees, aspect " << turn.aspect << ", raster at "
                    << rasterTime << ", u " << u;
            }
        }
}

TEST(MotionArc, WhatSlidesGrowsOrIsShearedGoesStraight) {
    const vec2 motion(30.0f, -12.0f);
    const auto expectStraight = [&](vec2 dx, vec2 dy) {
        const Arc arc = makeArc(motion, dx, dy, 1.0f);
        EXPECT_TRUE(isStraight(arc));
        EXPECT_EQ(placeOnArc(arc, 0.7f), motion * 0.7f);
    };
    expectStraight(vec2(0.0f), vec2(0.0f));
    expectStraight(vec2(0.2f, 0.0f), vec2(0.0f, 0.2f));  // comes nearer
    expectStraight(vec2(0.0f), vec2(0.4f, 0.0f));        // a floor that a camera passes
    expectStraight(vec2(0.1f, 0.0f), vec2(0.5f, -0.1f)); // and one that it drives over
    expectStraight(vec2(0.0f, 0.01f), vec2(-0.01f, 0.0f));
}

TEST(MotionArc, SlopesThatNoTurnBelow70DegreesHasGoStraight) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const float infinity = std::numeric_limits<float>::infinity();
    const vec2 motion(30.0f, -12.0f);
    for (const float slope : {1.3f, 2.0f, 1e6f, 1e30f, infinity, nan}) {
        const Arc arc = makeArc(motion, vec2(0.0f, slope), vec2(-slope, 0.0f), 0.5f);
        EXPECT_TRUE(isStraight(arc)) << slope;
    }
    // Up to there all places are finite.
    for (float slope = 0.0f; slope < 1.25f; slope += 0.01f)
        for (const float rasterTime : {0.0f, 0.5f, 1.0f}) {
            const Arc arc = makeArc(motion, vec2(-slope, slope), vec2(-slope, -slope), rasterTime);
            const vec2 place = placeOnArc(arc, rasterTime - 1.0f);
            EXPECT_LT(glm::length(place), 200.0f) << slope << ", " << rasterTime;
        }
}

} // namespace
} // namespace shutter::shader
