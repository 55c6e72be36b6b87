// SPDX-License-Identifier: MIT
// What this process takes of the machine, for measurements.
#pragma once

#include <cstdint>
#include <fstream>
#include <optional>
#include <string>

namespace shutter::test {

/// Bytes of this process in main memory; nothing if the system does not report it (Linux does).
[[nodiscard]] inline std::optional<uint64_t> findResidentBytes() {
    std::ifstream file("/proc/self/status");
    std::string word;
    while (file >> word && word != "VmRSS:")
        ;
    uint64_t kibibytes = 0;
    return file >> kibibytes ? std::optional(kibibytes * 1024) : std::nullopt;
}

} // namespace shutter::test
