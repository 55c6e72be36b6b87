// SPDX-License-Identifier: MIT
#include "engine/render/renderer.h"

#include <gtest/gtest.h>

namespace shutter::render {

TEST(IdleCounter, SaysOnceThatNobodyWantedItForAWhile) {
    IdleCounter counter;
    EXPECT_FALSE(counter.advance(true));
    for (uint32_t frame = 1; frame < kFramesKept; ++frame)
        EXPECT_FALSE(counter.advance(false)) << frame;
    EXPECT_TRUE(counter.advance(false));
    for (uint32_t frame = 0; frame < 3 * kFramesKept; ++frame)
        EXPECT_FALSE(counter.advance(false)) << frame;
}

TEST(IdleCounter, AWishStartsItAnew) {
    IdleCounter counter;
    for (uint32_t frame = 0; frame < 5 * kFramesKept; ++frame)
        EXPECT_FALSE(counter.advance(frame % (kFramesKept - 1) == 0)) << frame;
}

} // namespace shutter::render
