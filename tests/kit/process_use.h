// SPDX-License-Identifier: MIT
// What this process takes of the machine, for measurements.
#pragma once

#include <cstdint>
#include <optional>

namespace shutter::test {

/// Bytes of this process in main memory; nothing where the system does not say (it does on Linux).
[[nodiscard]] std::optional<uint64_t> findResidentBytes();

} // namespace shutter::test
