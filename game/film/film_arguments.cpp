// SPDX-License-Identifier: MIT
#include "game/film/film_arguments.h"

#include "game/film/film_plan.h"
#include "game/options/option_rows.h"
#include "game/parts/part_commands.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <array>

namespace shutter::film {

using core::makeError;

namespace {

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
    parts::defineJobOptions(command, a.jobs);
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
    game::addParsedOption(
        command,
        "--estimate",
        "on (default): draw some frames small and give each part the same work; off: the same "
        "number of frames",
        [&a](const std::string& text) { return game::parseOption(text, a.estimate); }
    );
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
    return parts::checkJobs(a.jobs);
}

std::vector<std::string> listRenderWords(const FilmArguments& arguments) {
    constexpr std::array<std::string_view, 1> kLeft = {"--restart"};
    return parts::listTypedWords(arguments.renderOptions, kLeft);
}

uint32_t countParts(const FilmArguments& arguments) {
    return arguments.parts.value_or(arguments.jobs.slurm ? kSlurmParts : arguments.jobs.jobs);
}

} // namespace shutter::film
