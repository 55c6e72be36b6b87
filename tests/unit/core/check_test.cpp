// SPDX-License-Identifier: MIT
#include "engine/core/check.h"

#include <gtest/gtest.h>

namespace shutter::core {
namespace {

TEST(Check, ATrueConditionPassesAndIsEvaluatedOnce) {
    int evaluations = 0;
    SHUTTER_CHECK(++evaluations == 1, "never printed");
    EXPECT_EQ(evaluations, 1);
    SHUTTER_CHECK_EQ(++evaluations, 2);
    EXPECT_EQ(evaluations, 2);
}

TEST(CheckDeathTest, AFalseConditionNamesItselfItsPlaceAndTheDetail) {
    const int count = 3;
    EXPECT_DEATH(
        SHUTTER_CHECK(count < 3, "count is {}", count),
        "check_test.cpp:[0-9]+: CHECK failed: count < 3 \\(count is 3\\)"
    );
}

TEST(CheckDeathTest, AnInequalityPrintsBothValues) {
    const int left = 4;
    EXPECT_DEATH(SHUTTER_CHECK_EQ(left, 5), "left == 5 \\(4 and 5\\)");
}

TEST(Check, ActsAsOneStatementInAnIfWithElse) {
    bool reachedElse = false;
    if (reachedElse)
        SHUTTER_CHECK(true, "unused");
    else
        reachedElse = true;
    EXPECT_TRUE(reachedElse);
}

} // namespace
} // namespace shutter::core
