// SPDX-License-Identifier: MIT
#include "game/film/film_command.h"

#include "engine/gpu/device.h"
#include "game/film/film.h"
#include "game/film/film_arguments.h"
#include "game/film/film_estimate.h"
#include "game/film/film_part.h"
#include "game/options/program.h"
#include "game/output/fingerprint.h"
#include "game/output/sequence.h"
#include "game/output/sequence_journal.h"
#include "game/parts/part_commands.h"
#include "game/parts/part_processes.h"
#include "game/parts/part_slurm.h"

#include <CLI/CLI.hpp>

#include <memory>
#include <string>
#include <system_error>
#include <utility>

namespace shutter::film {

namespace fs = std::filesystem;

using core::makeError;
using game::fail;

namespace {

/// Costs that the parts share equally.
core::Result<std::vector<double>>
findCosts(const FilmArguments& arguments, const Film& film, const game::Shot& shot) {
    const size_t frames = film.options.shot.frameTimes.size();
    if (!arguments.estimate || countParts(arguments) == 1)
        return std::vector<double>(frames, 1.0);
    gpu::DeviceOptions options = film.options.device;
    options.cacheFolder = game::findCacheFolder();
    auto device = gpu::Device::create(options);
    if (!device)
        return makeError("{}; --estimate off plans without a device", device.error().message);
    return estimateCosts(film.options, shot, *device.value());
}

/// The parts of a plan that is there already. Nothing: there is none, or it is not to be kept.
/// Error: it is another film's, or splits this one otherwise.
core::Result<std::vector<FilmPart>>
findPlannedParts(const FilmArguments& arguments, const Film& film) {
    std::error_code ignored;
    const fs::path file = planFile(film.work);
    const bool isPlanned = fs::exists(file, ignored);
    auto plan = isPlanned ? readPlan(file) : core::Result<FilmPlan>(FilmPlan());
    if (arguments.render.output.restart) {
        Film old = film;
        if (plan)
            old.plan = std::move(plan).value();
        removeWorkFiles(old);
        fs::remove(game::journalFile(film.options.output.out), ignored);
        return std::vector<FilmPart>();
    }
    if (!isPlanned)
        return std::vector<FilmPart>();
    if (!plan)
        return plan.error();
    // Processes may be drawing it: nothing of it is touched.
    if (plan.value().fingerprint != film.plan.fingerprint ||
        plan.value().frameCount() != film.options.shot.frameTimes.size())
        return makeError(
            "--out: '{}' holds a film that was planned otherwise; --restart draws this one instead",
            film.work.string()
        );
    if (arguments.parts && *arguments.parts != plan.value().parts.size())
        return makeError(
            "--parts {}: '{}' holds this film in {} parts; --restart splits it anew",
            *arguments.parts,
            film.work.string(),
            plan.value().parts.size()
        );
    return plan.value().parts;
}

core::Status makeWorkFolder(const Film& film) {
    if (!film.options.output.film.empty())
        return game::makeFilmFolder(film.options);
    std::error_code failure;
    fs::create_directory(film.work, failure);
    return failure
               ? core::Status(makeError(
                     "--out: cannot make the folder '{}': {}", film.work.string(), failure.message()
                 ))
               : core::Status();
}

/// Writes the plan into the working folder: the one that is there, or a new one.
core::Status planFilm(const FilmArguments& arguments, Film& film, const game::Shot& shot) {
    auto parts = findPlannedParts(arguments, film);
    if (!parts)
        return parts.error();
    film.plan.parts = std::move(parts).value();
    if (film.plan.parts.empty()) {
        const auto costs = findCosts(arguments, film, shot);
        if (!costs)
            return costs.error();
        film.plan.parts = splitIntoParts(costs.value(), countParts(arguments));
    }
    SHUTTER_TRY(makeWorkFolder(film));
    return writePlan(planFile(film.work), film.plan);
}

/// The film as typed, its frames planned; not its parts. The shot is loaded for the plan alone.
core::Result<std::pair<Film, game::Shot>>
makeFilm(const FilmArguments& arguments, game::RenderOptions options) {
    SHUTTER_TRY(game::checkOutputs(options));
    if (!options.output.film.empty())
        if (auto encoder = game::prepareFilm(options); !encoder)
            return encoder.error();
    auto shot = game::loadShot(options.shot);
    if (!shot)
        return shot.error();
    SHUTTER_TRY(game::planClipFrames(shot.value().world, options.shot));
    auto fingerprint = game::computeFingerprint(options, shot.value());
    if (!fingerprint)
        return fingerprint.error();
    std::error_code failure;
    Film film;
    film.work = fs::absolute(findWorkFolder(options.output), failure).lexically_normal();
    film.plan.fingerprint = std::move(fingerprint).value();
    film.plan.folder = fs::current_path(failure);
    if (failure)
        return makeError("cannot tell the folder that this is: {}", failure.message());
    film.plan.words = listRenderWords(arguments);
    film.options = std::move(options);
    return std::pair(std::move(film), std::move(shot).value());
}

core::Status drawHere(const FilmArguments& arguments, const Film& film) {
    SHUTTER_TRY(parts::runHere(describeWork(film), arguments.jobs));
    return finishFilm(film);
}

int runFilm(const FilmArguments& arguments) {
    auto options = game::interpret(arguments.render);
    if (!options)
        return fail(game::kExitUsage, options.error());
    if (core::Status able = checkFilm(arguments, options.value()); !able)
        return fail(game::kExitUsage, able.error());
    core::Status loaded = game::loadFlythrough(arguments.render.shot, options.value().shot);
    if (!loaded)
        return fail(game::kExitFailed, loaded.error());
    auto prepared = makeFilm(arguments, std::move(options).value());
    if (!prepared)
        return fail(game::kExitFailed, prepared.error());
    Film film = std::move(prepared.value().first);
    {
        const game::Shot shot = std::move(prepared.value().second);
        film.plan.parts = {{0, uint32_t(film.options.shot.frameTimes.size())}};
        if (!arguments.render.output.restart && isFilmFinished(film)) {
            fmt::print(
                "{}: is complete and skipped (--restart draws it)\n",
                film.options.output.film.string()
            );
            return game::kExitDone;
        }
        if (core::Status planned = planFilm(arguments, film, shot); !planned)
            return fail(game::kExitFailed, planned.error());
    }
    const core::Status drawn = arguments.jobs.slurm
                                   ? parts::runBySlurm(describeWork(film), arguments.jobs)
                                   : drawHere(arguments, film);
    return drawn ? game::kExitDone : fail(game::kExitFailed, drawn.error());
}

core::Status runPart(const parts::PartArguments& arguments) {
    auto film = openFilm(arguments.folder);
    if (!film)
        return film.error();
    return drawPart(std::move(film).value(), arguments.part, arguments.device);
}

core::Status runFinish(const parts::PartArguments& arguments) {
    auto film = openFilm(arguments.folder);
    return film ? finishFilm(std::move(film).value()) : core::Status(film.error());
}

} // namespace

void addFilmCommands(CLI::App& app, int& exitStatus) {
    CLI::App* command = app.add_subcommand("film", "draw a film in parts, by many processes");
    auto arguments = std::make_shared<FilmArguments>();
    defineFilmOptions(*command, *arguments);
    command->callback([arguments, &exitStatus] { exitStatus = runFilm(*arguments); });

    parts::addPartCommands(
        app, exitStatus, {kFilmNoun, kPartCommand, kFinishCommand, runPart, runFinish}
    );
}

} // namespace shutter::film
