// SPDX-License-Identifier: MIT
// Checks for programming errors: print the expectation and both values, then abort. Enabled in
// every build.
#pragma once

#include <fmt/format.h>

#include <string>

namespace shutter::core {

/// Prints "file:line: CHECK failed: expression (detail)" to stderr and aborts.
[[noreturn]] void
failCheck(const char* file, int line, const char* expression, const std::string& detail);

} // namespace shutter::core

#define SHUTTER_CHECK(condition, ...)                                                              \
    do {                                                                                           \
        if (!(condition)) [[unlikely]]                                                             \
            ::shutter::core::failCheck(                                                            \
                __FILE__, __LINE__, #condition, ::fmt::format(__VA_ARGS__)                         \
            );                                                                                     \
    } while (false)

#define SHUTTER_CHECK_EQ(a, b)                                                                     \
    do {                                                                                           \
        const auto& checkA_ = (a);                                                                 \
        const auto& checkB_ = (b);                                                                 \
        if (!(checkA_ == checkB_)) [[unlikely]]                                                    \
            ::shutter::core::failCheck(                                                            \
                __FILE__, __LINE__, #a " == " #b, ::fmt::format("{} and {}", checkA_, checkB_)     \
            );                                                                                     \
    } while (false)
