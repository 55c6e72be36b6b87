// SPDX-License-Identifier: MIT
#include "game/quartiles.h"

#include <gtest/gtest.h>

namespace shutter::game {

TEST(Quartiles, OneValueIsAllThree) {
    const Quartiles one = computeQuartiles({4.0});
    EXPECT_EQ(one.median, 4.0);
    EXPECT_EQ(one.q1, 4.0);
    EXPECT_EQ(one.q3, 4.0);
}

TEST(Quartiles, AreThoseOfNumpyWhateverTheOrder) {
    // numpy.percentile([1, 2, 4, 8, 16, 32], [25, 50, 75])
    const Quartiles six = computeQuartiles({32.0, 1.0, 16.0, 2.0, 8.0, 4.0});
    EXPECT_DOUBLE_EQ(six.q1, 2.5);
    EXPECT_DOUBLE_EQ(six.median, 6.0);
    EXPECT_DOUBLE_EQ(six.q3, 14.0);
}

} // namespace shutter::game
