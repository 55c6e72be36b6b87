// SPDX-License-Identifier: MIT
// What this process takes of the machine, for measurements.
#pragma once

#include <cstdint>
#include <optional>

namespace shutter::test {

/// Bytes of this process in main memory; nothing if the system does not report it (Linux does).
[[nodiscard]] std::optional<uint64_t> findResidentBytes();

} // namespace shutter::test
