// SPDX-License-Identifier: MIT
#include "engine/core/log.h"

#include <atomic>
#include <cstdio>

namespace shutter::core {

namespace {

std::atomic<LogLevel> gLevel = LogLevel::Warning;

} // namespace

void setLogLevel(LogLevel level) {
    gLevel = level;
}

void writeLog(LogLevel level, std::string_view text) {
    if (level < gLevel.load())
        return;
    fmt::print(stderr, "shutter: {}{}\n", level == LogLevel::Warning ? "warning: " : "", text);
}

} // namespace shutter::core
