// SPDX-License-Identifier: MIT
#include "engine/gpu/frame.h"

#include <gtest/gtest.h>

#include <cstdint>

namespace shutter::gpu {
namespace {

TEST(Timestamps, ACounterThatWrapsCountsOn) {
    for (const uint32_t bits : {36u, 40u, 64u}) {
        const uint64_t last = UINT64_MAX >> (64 - bits);
        EXPECT_EQ(countTicks(last - 9, 20, bits), 30u) << bits;
        EXPECT_EQ(countTicks(last, 0, bits), 1u) << bits;
    }
}

TEST(Timestamps, TimesWithoutAWrapAreTheDifference) {
    for (const uint32_t bits : {36u, 40u, 64u}) {
        const uint64_t last = UINT64_MAX >> (64 - bits);
        EXPECT_EQ(countTicks(1000, 1500, bits), 500u) << bits;
        EXPECT_EQ(countTicks(7, 7, bits), 0u) << bits;
        EXPECT_EQ(countTicks(0, last, bits), last) << bits;
    }
}

} // namespace
} // namespace shutter::gpu
