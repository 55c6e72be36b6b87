// SPDX-License-Identifier: MIT
#include "game/bench/parallel_jobs.h"

#include <gtest/gtest.h>

#include <atomic>
#include <vector>

namespace shutter::bench {
namespace {

TEST(ParallelJobs, EachRunsOnce) {
    std::vector<std::atomic<int>> runs(100);
    runParallelJobs(runs.size(), [&](size_t i) { ++runs[i]; });
    for (const auto& count : runs)
        EXPECT_EQ(count, 1);
    runParallelJobs(0, [](size_t) { FAIL() << "there is none"; });
}

} // namespace
} // namespace shutter::bench
