// SPDX-License-Identifier: MIT
// The options by which a person says who does the parts of a work.
#pragma once

#include "engine/core/result.h"

#include <cstdint>
#include <string>
#include <vector>

namespace CLI {
class App;
}

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

} // namespace shutter::parts
