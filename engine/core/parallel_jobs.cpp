// SPDX-License-Identifier: MIT
#include "engine/core/parallel_jobs.h"

#include <algorithm>
#include <atomic>
#include <thread>
#include <vector>

namespace shutter::core {

void runParallelJobs(size_t count, const std::function<void(size_t)>& job) {
    std::atomic<size_t> next = 0;
    const auto work = [&] {
        for (size_t i = next++; i < count; i = next++)
            job(i);
    };
    const size_t threads = std::clamp<size_t>(std::thread::hardware_concurrency(), 1, 16);
    std::vector<std::jthread> others; // waits for them when it goes
    for (size_t i = 1; i < std::min(threads, count); ++i)
        others.emplace_back(work);
    work();
}

} // namespace shutter::core
