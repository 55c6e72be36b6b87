// SPDX-License-Identifier: MIT
// Other programs, run without a shell.
#pragma once

#include "engine/core/result.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace shutter::io {

struct ProcessResult {
    int exitStatus = 0; ///< as a shell counts: 128 + number where a signal ended it
    std::string output; ///< of stdout, the first MiB
    std::string errors; ///< of stderr, the last 64 KiB
};

/// The program that a shell would find on PATH.
[[nodiscard]] std::optional<std::filesystem::path> findProgram(const std::string& name);

/// Runs `program` with nothing on its stdin and waits for its end. It is killed if this thread ends
/// first for any reason.
/// \param folder where it runs
/// Error: it cannot be started.
[[nodiscard]] core::Result<ProcessResult> runProcess(
    const std::filesystem::path& program,
    const std::vector<std::string>& arguments,
    const std::filesystem::path& folder
);

} // namespace shutter::io
