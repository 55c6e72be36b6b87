// SPDX-License-Identifier: MIT
// What this process takes of the machine, for measurements.
#pragma once

#include <cstdint>
#include <optional>

namespace shutter::test {

/// Bytes of this process in main memory; nothing where the system does not say (it does on Linux).
[[nodiscard]] std::optional<uint64_t> findResidentBytes();

/// Milliseconds of processors that this process has used since its start, those of all its threads
/// together, a software device's included.
[[nodiscard]] double countProcessorMilliseconds();

} // namespace shutter::test
