// SPDX-License-Identifier: MIT
#include "engine/core/parallel_jobs.h"

#include <gtest/gtest.h>

#include <atomic>
#include <vector>

namespace shutter::core {
namespace {

TEST(ParallelJobs, EachRunsOnce) {
    std::vector<std::atomic<int>> runs(100);
    runParallelJobs(runs.size(), [&](size_t i) { ++runs[i]; });
    for (const auto& count : runs)
        EXPECT_EQ(count, 1);
    runParallelJobs(0, [](size_t) { FAIL() << "there is none"; });
}

} // namespace
} // namespace shutter::core
