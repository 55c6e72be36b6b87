// SPDX-License-Identifier: MIT
#include "engine/core/words.h"

#include <gtest/gtest.h>

namespace shutter::core {

TEST(Words, OneIsSingularAndAllElseIsPlural) {
    EXPECT_EQ(countOf(0, "frame"), "0 frames");
    EXPECT_EQ(countOf(1, "frame"), "1 frame");
    EXPECT_EQ(countOf(2, "frame"), "2 frames");
    EXPECT_EQ(countOf(1, "vertex", "vertices"), "1 vertex");
    EXPECT_EQ(countOf(3, "vertex", "vertices"), "3 vertices");
    EXPECT_EQ(thereAre(0, "light"), "there are 0 lights");
    EXPECT_EQ(thereAre(1, "light"), "there is 1 light");
    EXPECT_EQ(thereAre(2, "mesh", "meshes"), "there are 2 meshes");
}

} // namespace shutter::core
