// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <functional>

namespace shutter::core {

/// Runs job(0) to job(count - 1) on as many threads as there are processors, in no order, and waits
/// for all of them. Jobs must not share data that any of them writes, and must not throw.
void runParallelJobs(size_t count, const std::function<void(size_t)>& job);

} // namespace shutter::core
