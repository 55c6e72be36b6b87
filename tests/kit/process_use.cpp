// SPDX-License-Identifier: MIT
#include "tests/kit/process_use.h"

#include <fstream>
#include <string>

namespace shutter::test {

std::optional<uint64_t> findResidentBytes() {
    std::ifstream file("/proc/self/status");
    std::string word;
    while (file >> word && word != "VmRSS:")
        ;
    uint64_t kibibytes = 0;
    if (!(file >> kibibytes))
        return std::nullopt;
    return kibibytes * 1024;
}

} // namespace shutter::test
