// SPDX-License-Identifier: MIT
// The functions that the layer stands in for, by what they fail at.
#pragma once

#include "tests/fault_layer/dispatch.h"

#include <span>

namespace shutter::faults {

/// Other limits, features, extensions and types of memory.
[[nodiscard]] std::span<const Entry> listReports();

/// Allocations that fail, and memory of the reported types.
[[nodiscard]] std::span<const Entry> listMemoryFaults();

/// Submissions, and everything that tells of a lost device.
[[nodiscard]] std::span<const Entry> listLostDevice();

/// Windows that change and go away.
[[nodiscard]] std::span<const Entry> listSwapchainFaults();

} // namespace shutter::faults
