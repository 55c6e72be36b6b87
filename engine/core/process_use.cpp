// SPDX-License-Identifier: MIT
#include "engine/core/process_use.h"

#include <ctime>
#include <fstream>
#include <unistd.h>

namespace shutter::core {

std::optional<uint64_t> findResidentBytes() {
    std::ifstream file("/proc/self/statm");
    uint64_t all = 0;
    uint64_t resident = 0;
    if (!(file >> all >> resident))
        return std::nullopt;
    return resident * static_cast<uint64_t>(sysconf(_SC_PAGESIZE));
}

double countProcessorMilliseconds() {
    return 1e3 * double(std::clock()) / CLOCKS_PER_SEC;
}

} // namespace shutter::core
