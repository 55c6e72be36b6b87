// SPDX-License-Identifier: MIT
// A film drawn by Slurm's job arrays: a task for each part, and a job after them that finishes the
// film. When and where they run is Slurm's affair: its programs sbatch, squeue and scancel are
// told.
#pragma once

#include "engine/core/result.h"
#include "game/film/film.h"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace shutter::film {

/// Ids of jobs, as sbatch tells them.
struct SlurmJobs {
    std::string parts; ///< of the array; empty: every part was complete
    std::string finish;
};

/// "0-3,7": indices of an array's tasks.
[[nodiscard]] std::string formatTasks(std::span<const uint32_t> tasks);

/// Options for sbatch, each as typed: "gres=gpu:1" or "--gres=gpu:1".
struct SlurmOptions {
    std::vector<std::string> all;   ///< of all jobs
    std::vector<std::string> parts; ///< of the array alone
};

/// Submits the parts and the job that finishes, and records their ids in the working folder.
/// Error: sbatch's own words; then nothing stays submitted.
[[nodiscard]] core::Result<SlurmJobs>
submitFilm(const Film& film, const std::vector<uint32_t>& parts, const SlurmOptions& options);

/// The film's jobs that were submitted before and are in the queue still, if any.
/// Error: squeue's own words, or the record is damaged.
[[nodiscard]] core::Result<std::optional<SlurmJobs>> findQueuedJobs(const Film& film);

/// Waits until the jobs have left the queue, with a bar of their progress on stderr.
/// Error: the film is not finished then; says what the first part that is not complete said last.
[[nodiscard]] core::Status followJobs(const Film& film, const SlurmJobs& jobs);

} // namespace shutter::film
