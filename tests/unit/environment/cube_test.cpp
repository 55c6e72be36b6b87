// SPDX-License-Identifier: MIT
#include "engine/environment/cube.h"
#include "engine/environment/directions.h"

#include <gtest/gtest.h>

namespace shutter::environment {
namespace {

using math::dvec3;

/// What a person inside the cube sees: forwards, right and up of each stored side.
struct View {
    dvec3 forward;
    dvec3 right;
    dvec3 up;
};

constexpr View kViews[6] = {
    {{1, 0, 0}, {0, 0, 1}, {0, 1, 0}},
    {{-1, 0, 0}, {0, 0, -1}, {0, 1, 0}},
    {{0, 1, 0}, {-1, 0, 0}, {0, 0, -1}},
    {{0, -1, 0}, {-1, 0, 0}, {0, 0, 1}},
    {{0, 0, 1}, {-1, 0, 0}, {0, 1, 0}},
    {{0, 0, -1}, {1, 0, 0}, {0, 1, 0}}};

TEST(Cube, EachDirectionIsSeenOnTheSideThatShowsIt) {
    constexpr uint32_t kSize = 64;
    std::array<image::Image, 6> sides;
    for (size_t i = 0; i < 6; ++i) {
        sides[i] = image::Image(kSize, kSize, 3);
        for (uint32_t y = 0; y < kSize; ++y)
            for (uint32_t x = 0; x < kSize; ++x) {
                const dvec3 d = glm::normalize(
                    kViews[i].forward + kViews[i].right * ((x + 0.5) / kSize * 2.0 - 1.0) -
                    kViews[i].up * ((y + 0.5) / kSize * 2.0 - 1.0)
                );
                for (int c = 0; c < 3; ++c)
                    sides[i].at(x, y, uint32_t(c)) = float(d[c]);
            }
    }
    const image::Image picture = unwrapCube(sides, 128);
    ASSERT_EQ(picture.height, 64u);
    for (uint32_t y = 0; y < 64; ++y)
        for (uint32_t x = 0; x < 128; ++x) {
            const dvec3 expected = directionAt({(x + 0.5) / 128.0, (y + 0.5) / 64.0});
            for (int c = 0; c < 3; ++c)
                // Half a texel of a side is lost at its border.
                ASSERT_NEAR(picture.at(x, y, uint32_t(c)), expected[c], 0.02) << x << " " << y;
        }
}

} // namespace
} // namespace shutter::environment
