// SPDX-License-Identifier: MIT
// Where a pixel's surface goes during the exposure, packed into two words.
#include "shaders/common/pixel_way.glsl"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace shutter {
namespace {

using glm::vec2;
using shader::PixelWay;

float measureOff(const PixelWay& way) {
    const PixelWay back = shader::unpackWay(shader::packWay(way));
    float off = 0.0f;
    for (const vec2 gap : {back.open - way.open, back.close - way.close, back.bend - way.bend})
        off = std::max({off, std::abs(gap.x), std::abs(gap.y)});
    return off;
}

TEST(PixelWays, AWayIsPackedToA64thOfAPixelOrAShareOfItsLength) {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> share(-1.0f, 1.0f);
    const auto draw = [&](float most) { return most * vec2(share(random), share(random)); };
    for (const float longest : {1.0f, 15.0f, 31.0f, 100.0f, 1000.0f, 32768.0f})
        for (int i = 0; i < 200; ++i) {
            const PixelWay way{draw(longest), draw(longest), draw(longest / 16.0f)};
            EXPECT_LE(measureOff(way), std::max(1.0f / 64.0f, longest / 1000.0f)) << longest;
        }
}

TEST(PixelWays, AWayThatBendsMoreThanItIsLongIsPackedByItsBend) {
    const PixelWay way{vec2(1.0f, -0.5f), vec2(0.0f), vec2(30.0f, -20.0f)};
    EXPECT_LE(measureOff(way), 0.25f);
}

TEST(PixelWays, NoWayIsKeptExactly) {
    const PixelWay none{vec2(0.0f), vec2(0.0f), vec2(0.0f)};
    EXPECT_EQ(measureOff(none), 0.0f);
}

TEST(PixelWays, NoPackedWayIsTheMarkOfNone) {
    for (const float far : {1.0e3f, 1.0e6f, 1.0e20f}) {
        const PixelWay way{vec2(far), vec2(far), vec2(far)};
        EXPECT_NE(shader::packWay(way).x, shader::kNoWay);
        const PixelWay other{vec2(-far), vec2(-far), vec2(-far)};
        EXPECT_NE(shader::packWay(other).x, shader::kNoWay);
    }
}

TEST(PixelWays, AWayGoesThroughItsEndsAndItsMiddle) {
    const PixelWay way{vec2(-8.0f, 2.0f), vec2(4.0f, 0.0f), vec2(1.0f, 3.0f)};
    EXPECT_EQ(shader::displacementAt(way, 0.0f), way.open);
    EXPECT_EQ(shader::displacementAt(way, 1.0f), way.close);
    EXPECT_EQ(shader::displacementAt(way, 0.5f), vec2(-1.0f, 4.0f));
}

TEST(PixelWays, AStraightWayPassesTheRasterAtItsTime) {
    const PixelWay way = shader::straightWay(vec2(12.0f, -4.0f), 0.25f);
    EXPECT_EQ(shader::displacementAt(way, 0.25f), vec2(0.0f));
    EXPECT_EQ(way.close - way.open, vec2(12.0f, -4.0f));
}

} // namespace
} // namespace shutter
