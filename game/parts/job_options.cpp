// SPDX-License-Identifier: MIT
#include "game/parts/job_options.h"

#include <CLI/CLI.hpp>

namespace shutter::parts {

using core::makeError;

namespace {

constexpr uint32_t kMaxJobs = 256;

} // namespace

void defineJobOptions(CLI::App& command, JobOptions& o) {
    command.add_option("--jobs", o.jobs, "processes that work at once; default 1")
        ->check(CLI::Range(1u, kMaxJobs));
    command.add_option(
        "--devices", o.devices, "devices that the processes of --jobs take in turn, comma-separated"
    );
    command.add_flag("--slurm", o.slurm, "submit the parts to Slurm and print the ids of the jobs");
    command.add_option(
        "--sbatch", o.sbatch, "with --slurm: option for sbatch, e.g. partition=films (repeatable)"
    );
    command.add_option(
        "--sbatch-part",
        o.sbatchPart,
        "with --slurm: option for the jobs that draw alone, e.g. gres=gpu:1 (repeatable)"
    );
    command.add_flag("--wait", o.wait, "with --slurm: wait until all is finished");
}

core::Status checkJobs(const JobOptions& o) {
    if (!o.slurm && (!o.sbatch.empty() || !o.sbatchPart.empty() || o.wait))
        return makeError(
            "{} needs --slurm",
            o.wait ? "--wait" : (o.sbatch.empty() ? "--sbatch-part" : "--sbatch")
        );
    if (o.slurm && (o.jobs > 1 || !o.devices.empty()))
        return makeError("{} and --slurm exclude each other", o.jobs > 1 ? "--jobs" : "--devices");
    return {};
}

} // namespace shutter::parts
