// SPDX-License-Identifier: MIT
// Messages for the person at the terminal, on stderr; results go to files or stdout.
#pragma once

#include <fmt/format.h>

#include <string_view>
#include <utility>

namespace shutter::core {

enum class LogLevel {
    Info,    ///< Choices and findings; hidden by default.
    Warning, ///< The result is valid but differs from the request.
};

/// Messages below `level` are dropped. Default: Warning.
void setLogLevel(LogLevel level);

/// Writes "shutter: text" (with "warning: " for warnings) to stderr.
void writeLog(LogLevel level, std::string_view text);

template <class... Args> void logInfo(fmt::format_string<Args...> format, Args&&... args) {
    writeLog(LogLevel::Info, fmt::format(format, std::forward<Args>(args)...));
}

template <class... Args> void logWarning(fmt::format_string<Args...> format, Args&&... args) {
    writeLog(LogLevel::Warning, fmt::format(format, std::forward<Args>(args)...));
}

} // namespace shutter::core
