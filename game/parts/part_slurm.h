// SPDX-License-Identifier: MIT
// Parts that Slurm's job arrays do: a task for each part, and a job after them that finishes the
// work. When and where they run is Slurm's affair: its programs sbatch, squeue and scancel are
// told.
#pragma once

#include "engine/core/result.h"
#include "game/parts/job_options.h"
#include "game/parts/part_work.h"

#include <cstdint>
#include <span>
#include <string>

namespace shutter::parts {

/// "0-3,7": indices of an array's tasks.
[[nodiscard]] std::string formatTasks(std::span<const uint32_t> tasks);

/// Submits the parts that are not done and the job that finishes, prints their ids, and records
/// them in the working folder; says so where jobs that were submitted before are in the queue
/// still. With `options.wait` it follows them with a bar of their progress on stderr.
/// Error: the words of sbatch or squeue, and then nothing stays submitted; or, after waiting, that
/// the work is not finished, with what the first part that is not done said last.
[[nodiscard]] core::Status runBySlurm(const PartWork& work, const JobOptions& options);

} // namespace shutter::parts
