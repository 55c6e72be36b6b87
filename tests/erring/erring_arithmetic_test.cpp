// SPDX-License-Identifier: MIT
#include "tests/erring/erring_arithmetic.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

namespace shutter::erring {
namespace {

/// Units in the last place between two floats of one sign.
int countUlps(float from, float to) {
    return static_cast<int>(std::bit_cast<uint32_t>(to) - std::bit_cast<uint32_t>(from));
}

TEST(ErringArithmetic, QuotientsAreOffByTwoUnitsAtMostInBothDirections) {
    std::set<int> seen;
    for (int a = 1; a < 100; ++a)
        for (int b = 1; b < 100; ++b)
            seen.insert(countUlps(float(a) / float(b), float(a) / kErring / float(b)));
    EXPECT_EQ(seen, (std::set<int>{-2, -1, 0, 1, 2}));
}

TEST(ErringArithmetic, ComponentsErrAndWholeNumbersConstantsZeroAndInfinityDoNot) {
    const glm::vec2 quotient = glm::vec2(3.0f, 7.0f) / kErring / 9.0f;
    EXPECT_EQ(quotient, glm::vec2(3.0f / kErring / 9.0f, 7.0f / kErring / 9.0f));
    EXPECT_EQ(glm::uvec2(17u, 9u) / kErring / 5u, glm::uvec2(3u, 1u));
    constexpr float kFolded = 1.0f / kErring / 3.0f;
    EXPECT_EQ(kFolded, 1.0f / 3.0f);
    EXPECT_EQ(err(0.0f), 0.0f);
    EXPECT_TRUE(std::isinf(err(std::numeric_limits<float>::infinity())));
    EXPECT_TRUE(std::isnan(shader::sqrt(-1.0f)));
    EXPECT_TRUE(std::isfinite(err(std::numeric_limits<float>::max())));
    EXPECT_GT(err(std::numeric_limits<float>::denorm_min()), 0.0f);
}

} // namespace
} // namespace shutter::erring
