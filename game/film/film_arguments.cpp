// SPDX-License-Identifier: MIT
#include "game/film/film_arguments.h"

#include "game/film/film_plan.h"
#include "game/options/option_rows.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <array>

namespace shutter::film {

using core::makeError;

namespace {

constexpr uint32_t kMaxJobs = 256;

/// Options that print or time what one process draws.
constexpr std::array kAboutOneProcess = {
    "--stats", "--hash-passes", "--dump-graph", "--explain", "--repeat"};

bool isTyped(const FilmArguments& arguments, std::string_view name) {
    return std::any_of(
        arguments.renderOptions.begin(),
        arguments.renderOptions.end(),
        [&](const CLI::Option* option) { return option->get_name() == name && option->count() > 0; }
    );
}

} // namespace

void defineFilmOptions(CLI::App& command, FilmArguments& a) {
    game::defineRenderOptions(command, a.render);
    for (const CLI::Option* option : command.get_options())
        if (option->get_name() != "--help")
            a.renderOptions.push_back(option);
    command.add_option("--jobs", a.jobs, "processes that draw at once; default 1")
        ->check(CLI::Range(1u, kMaxJobs));
    command
        .add_option(
            "--parts",
            a.parts,
            fmt::format(
                "parts to draw the film in; default: one for each of --jobs, {} with --slurm",
                kSlurmParts
            )
        )
        ->check(CLI::Range(1u, kMaxParts));
    command.add_option(
        "--devices", a.devices, "devices that the processes of --jobs take in turn, comma-separated"
    );
    game::addParsedOption(
        command,
        "--estimate",
        "on (default): draw some frames small and give each part the same work; off: the same "
        "number of frames",
        [&a](const std::string& text) { return game::parseOption(text, a.estimate); }
    );
    command.add_flag("--slurm", a.slurm, "submit the parts to Slurm and print the ids of the jobs");
    command.add_option(
        "--sbatch", a.sbatch, "with --slurm: option for sbatch, e.g. partition=films (repeatable)"
    );
    command.add_option(
        "--sbatch-part",
        a.sbatchPart,
        "with --slurm: option for the jobs that draw alone, e.g. gres=gpu:1 (repeatable)"
    );
    command.add_flag("--wait", a.wait, "with --slurm: wait until the film is finished");
}

core::Status checkFilm(const FilmArguments& a, const game::RenderOptions& options) {
    if (!options.shot.isSequence)
        return makeError("a film needs --flythrough or --frames");
    for (const char* name : kAboutOneProcess)
        if (isTyped(a, name))
            return makeError("{} is about one process: it belongs to shutter render", name);
    if (!options.method.budget.isUnlimited())
        return makeError("--budget makes a frame depend on how fast the ones before were drawn");
    if (options.shot.antiAliasing == game::AntiAliasing::Taa && countParts(a) > 1)
        return makeError(
            "--aa taa makes a frame depend on all before it, which parts do not share: use "
            "--aa box, or --parts 1"
        );
    if (!a.slurm && (!a.sbatch.empty() || !a.sbatchPart.empty() || a.wait))
        return makeError(
            "{} needs --slurm",
            a.wait ? "--wait" : (a.sbatch.empty() ? "--sbatch-part" : "--sbatch")
        );
    if (a.slurm && (a.jobs > 1 || !a.devices.empty()))
        return makeError("{} and --slurm exclude each other", a.jobs > 1 ? "--jobs" : "--devices");
    return {};
}

std::vector<std::string> listRenderWords(const FilmArguments& arguments) {
    std::vector<std::string> words;
    std::vector<std::string> places; // in front: an option of many values would take them
    for (const CLI::Option* option : arguments.renderOptions) {
        const std::string name = option->get_name();
        if (option->count() == 0 || name == "--restart")
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

uint32_t countParts(const FilmArguments& arguments) {
    return arguments.parts.value_or(arguments.slurm ? kSlurmParts : arguments.jobs);
}

} // namespace shutter::film
