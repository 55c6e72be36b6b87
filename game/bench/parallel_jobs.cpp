// SPDX-License-Identifier: MIT
#include "game/bench/parallel_jobs.h"

#include <algorithm>
#include <atomic>
#include <future>
#include <thread>
#include <vector>

namespace shutter::bench {

void runParallelJobs(size_t count, const std::function<void(size_t)>& job) {
    std::atomic<size_t> next = 0;
    const auto work = [&] {
        for (size_t i = next++; i < count; i = next++)
            job(i);
    };
    const size_t threads = std::clamp<size_t>(std::thread::hardware_concurrency(), 1, 16);
    std::vector<std::future<void>> others;
    for (size_t i = 1; i < std::min(threads, count); ++i)
        others.push_back(std::async(std::launch::async, work));
    work();
    for (std::future<void>& other : others)
        other.get();
}

} // namespace shutter::bench
