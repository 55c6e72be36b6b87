// SPDX-License-Identifier: MIT
#include "modules/truth/truth.h"

#include <gtest/gtest.h>

#include <numeric>
#include <vector>

namespace shutter::truth {

namespace {

using Counts = std::vector<uint32_t>;

} // namespace

TEST(PlanBatches, ASmallPictureIsDoneInOne) {
    EXPECT_EQ(planBatches(64 * 48, 256, {}), (Counts{256}));
    EXPECT_EQ(planBatches(1, 65536, {}), (Counts{65536}));
}

TEST(PlanBatches, ALargeOneTakesARayAtATime) {
    EXPECT_EQ(planBatches(uint64_t(16384) * 16384, 3, {}), (Counts{1, 1, 1}));
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

TEST(PlanBatches, ABatchEndsAtEachStop) {
    const Counts stops{4, 1, 2, 2, 8};
    EXPECT_EQ(planBatches(100, 10, stops), (Counts{1, 1, 2, 4, 2}));
}

TEST(PlanBatches, StopsAtTheEndOrBeyondChangeNothing) {
    const Counts stops{10, 20};
    EXPECT_EQ(planBatches(100, 10, stops), (Counts{10}));
}

TEST(LodBias, TheBoxResolvesWhatItsRaysCan) {
    EXPECT_FLOAT_EQ(computeLodBias(PixelModel::Box, 256), -4.0f);
    EXPECT_FLOAT_EQ(computeLodBias(PixelModel::Box, 1), 0.0f);
    EXPECT_FLOAT_EQ(computeLodBias(PixelModel::Centre, 256), 0.0f);
}

} // namespace shutter::truth
