// SPDX-License-Identifier: MIT
#include "game/shot/instants.h"

#include <gtest/gtest.h>

#include <limits>

namespace shutter::game {

TEST(Instants, AStillFrameTakesOne) {
    const InstantChoice choice = chooseInstants({}, 1.0, 1024);
    EXPECT_EQ(choice.count, 1u);
    EXPECT_EQ(choice.reason, "nothing moves");
}

TEST(Instants, TheyAreNoFartherApartThanTheStep) {
    EXPECT_EQ(chooseInstants({10.0, false}, 1.0, 1024).count, 10u);
    EXPECT_EQ(chooseInstants({10.1, false}, 1.0, 1024).count, 11u);
    EXPECT_EQ(chooseInstants({10.0, false}, 4.0, 1024).count, 3u);
    EXPECT_EQ(chooseInstants({0.2, false}, 1.0, 1024).count, 1u);
}

TEST(Instants, MostLimitsThemAndTheStepTells) {
    const InstantChoice choice = chooseInstants({1000.0, false}, 1.0, 100);
    EXPECT_EQ(choice.count, 100u);
    EXPECT_DOUBLE_EQ(choice.stepPx, 10.0);
    EXPECT_EQ(chooseInstants({1.0e300, false}, 1.0e-3, 100).count, 100u);
    EXPECT_EQ(chooseInstants({std::numeric_limits<double>::infinity(), false}, 1.0, 7).count, 7u);
}

TEST(Instants, AMovingLightTakesSomeWhereNoPointMoves) {
    const InstantChoice choice = chooseInstants({0.0, true}, 1.0, 1024);
    EXPECT_EQ(choice.count, kLeastInstantsOfLight);
    EXPECT_EQ(choice.reason, "only light moves");
    EXPECT_EQ(chooseInstants({0.0, true}, 1.0, 4).count, 4u);
}

} // namespace shutter::game
