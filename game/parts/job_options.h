// SPDX-License-Identifier: MIT
// The options by which a person says who does the parts of a work.
#pragma once

#include "engine/core/result.h"

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace CLI {
class App;
class Option;
} // namespace CLI

namespace shutter::parts {

struct JobOptions {
    uint32_t jobs = 1;   ///< processes at once
    std::string devices; ///< names or indices, comma-separated
    bool slurm = false;
    std::vector<std::string> sbatch;     ///< options of all jobs
    std::vector<std::string> sbatchPart; ///< options of the array alone
    bool wait = false;
};

/// --jobs, --devices, --slurm, --sbatch, --sbatch-part and --wait.
void defineJobOptions(CLI::App& command, JobOptions& options);

/// Error: names the option that needs or excludes another.
[[nodiscard]] core::Status checkJobs(const JobOptions& options);

/// What was typed of `options` as words that mean the same, without those of the names in `left`.
[[nodiscard]] std::vector<std::string>
listTypedWords(std::span<const CLI::Option* const> options, std::span<const std::string_view> left);

} // namespace shutter::parts
