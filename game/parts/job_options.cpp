// SPDX-License-Identifier: MIT
#include "game/parts/job_options.h"

#include <CLI/CLI.hpp>

#include <algorithm>

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

std::vector<std::string> listTypedWords(
    std::span<const CLI::Option* const> options, std::span<const std::string_view> left
) {
    std::vector<std::string> words;
    std::vector<std::string> places; // in front: an option of many values would take them
    for (const CLI::Option* option : options) {
        const std::string name = option->get_name();
        if (option->count() == 0 || std::find(left.begin(), left.end(), name) != left.end())
            continue;
        const bool isFlag = option->get_items_expected_max() == 0;
        for (const std::string& value : option->results()) {
            if (option->get_lnames().empty()) {
                places.push_back(value);
                continue;
            }
            words.push_back(name);
            if (!isFlag)
                words.push_back(value);
        }
    }
    places.insert(places.end(), words.begin(), words.end());
    return places;
}

} // namespace shutter::parts
