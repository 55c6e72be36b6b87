// SPDX-License-Identifier: MIT
#pragma once

#include "engine/math/math.h"

#include <gtest/gtest.h>

#include <limits>

namespace shutter::scene {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
inline constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
inline const math::dvec3 kUp(0.0, 1.0, 0.0);
inline const math::dvec3 kUnitZ(0.0, 0.0, 1.0);

inline void
expectNear(const math::dvec3& actual, const math::dvec3& expected, double tolerance = 1e-9) {
    for (int i = 0; i < 3; ++i)
        EXPECT_NEAR(actual[i], expected[i], tolerance) << "axis " << i;
}

inline void
expectNear(const math::dmat4& actual, const math::dmat4& expected, double tolerance = 1e-9) {
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row)
            EXPECT_NEAR(actual[column][row], expected[column][row], tolerance) << column << row;
}

} // namespace shutter::scene
