// SPDX-License-Identifier: MIT
#include "engine/core/check.h"

#include <cstdio>
#include <cstdlib>

namespace shutter::core {

void failCheck(const char* file, int line, const char* expression, const std::string& detail) {
    fmt::print(stderr, "{}:{}: CHECK failed: {} ({})\n", file, line, expression, detail);
    std::fflush(stderr);
    std::abort();
}

} // namespace shutter::core
