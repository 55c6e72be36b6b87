// SPDX-License-Identifier: MIT
#include "modules/truth/truth.h"

#include <gtest/gtest.h>

#include <numeric>
#include <vector>

namespace shutter::truth {
namespace {

using Counts = std::vector<uint32_t>;

TEST(PlanBatches, BatchesAreAsLargeAsThePictureAllowsAndEndAtEachStop) {
    struct Case {
        uint64_t pixels;
        uint32_t rays;
        Counts stops;
        Counts batches;
    };

    const std::vector<Case> cases{
        {64 * 48, 256, {}, {256}},
        {1, 65536, {}, {65536}},
        {uint64_t(16384) * 16384, 3, {}, {1, 1, 1}},
        {100, 10, {4, 1, 2, 2, 8}, {1, 1, 2, 4, 2}},
        {100, 10, {10, 20}, {10}}}; // stops at the end or beyond change nothing
    for (const Case& each : cases)
        EXPECT_EQ(planBatches(each.pixels, each.rays, each.stops), each.batches) << each.pixels;
}

TEST(PlanBatches, AllRaysAreTracedAndNoBatchIsLong) {
    for (const uint32_t rays : {1u, 7u, 256u, 1000u}) {
        const Counts batches = planBatches(640 * 360, rays, {});
        EXPECT_EQ(std::accumulate(batches.begin(), batches.end(), 0u), rays);
        for (const uint32_t count : batches) {
            EXPECT_GT(count, 0u);
            EXPECT_LE(uint64_t(count) * 640 * 360, 1u << 21);
        }
    }
}

TEST(LodBias, TheBoxResolvesWhatItsRaysCan) {
    EXPECT_FLOAT_EQ(computeLodBias(PixelModel::Box, 256), -4.0f);
    EXPECT_FLOAT_EQ(computeLodBias(PixelModel::Box, 1), 0.0f);
    EXPECT_FLOAT_EQ(computeLodBias(PixelModel::Centre, 256), 0.0f);
}

} // namespace
} // namespace shutter::truth
