// SPDX-License-Identifier: MIT
#include "game/film/film.h"

#include "game/options/render_arguments.h"
#include "game/output/fingerprint.h"
#include "game/output/sequence.h"
#include "game/output/sequence_journal.h"
#include "game/parts/part_commands.h"
#include "game/parts/part_device.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <system_error>
#include <utility>

namespace shutter::film {

namespace fs = std::filesystem;

using core::makeError;

namespace {

core::Result<game::SequenceJournal>
readPartJournal(const Film& film, uint32_t part, const std::string& fingerprint) {
    return game::SequenceJournal::read(partJournal(film.options.output, part), fingerprint);
}

} // namespace

fs::path findWorkFolder(const game::OutputOptions& output) {
    if (!output.film.empty())
        return output.out.parent_path();
    return game::journalFile(output.out).replace_extension(".parts");
}

fs::path planFile(const fs::path& work) {
    return work / "plan.json";
}

fs::path partJournal(const game::OutputOptions& output, uint32_t part) {
    return game::journalFile(output.out).string() + fmt::format(".part_{}", part);
}

core::Result<game::RenderOptions> interpretWords(const std::vector<std::string>& words) {
    CLI::App app;
    game::RenderArguments arguments;
    game::defineRenderOptions(app, arguments);
    SHUTTER_TRY(parts::parseWords(app, words));
    auto options = game::interpret(arguments);
    if (!options)
        return options;
    SHUTTER_TRY(game::loadFlythrough(arguments.shot, options.value().shot));
    return options;
}

core::Result<Film> openFilm(const fs::path& work) {
    std::error_code failure;
    Film film;
    film.work = fs::absolute(work, failure).lexically_normal();
    auto plan = readPlan(planFile(film.work));
    if (!plan)
        return plan.error();
    film.plan = std::move(plan).value();
    fs::current_path(film.plan.folder, failure);
    if (failure)
        return makeError(
            "{}: the folder '{}' cannot be entered: {}",
            planFile(film.work).string(),
            film.plan.folder.string(),
            failure.message()
        );
    auto options = interpretWords(film.plan.words);
    if (!options)
        return makeError("{}: {}", planFile(film.work).string(), options.error().message);
    film.options = std::move(options).value();
    return film;
}

core::Result<game::Shot> loadPlannedShot(Film& film) {
    auto shot = game::loadShot(film.options.shot);
    if (!shot)
        return shot;
    SHUTTER_TRY(game::planClipFrames(shot.value().world, film.options.shot));
    const auto fingerprint = game::computeFingerprint(film.options, shot.value());
    if (!fingerprint)
        return fingerprint.error();
    if (fingerprint.value() != film.plan.fingerprint ||
        film.options.shot.frameTimes.size() != film.plan.frameCount())
        return makeError(
            "{}: the scene, a file that the options name or this program is not what it was when "
            "the film was planned",
            planFile(film.work).string()
        );
    return shot;
}

core::Result<std::optional<std::string>> findDrawnFingerprint(const Film& film) {
    const auto device = parts::readDevice(parts::deviceFile(film.work));
    if (!device)
        return device.error();
    std::optional<std::string> fingerprint;
    if (device.value())
        fingerprint =
            game::addDevice(film.plan.fingerprint, device.value()->name, device.value()->driver);
    return fingerprint;
}

uint32_t countDrawnFrames(const Film& film) {
    const auto fingerprint = findDrawnFingerprint(film);
    if (!fingerprint || !fingerprint.value())
        return 0;
    size_t drawn = 0;
    for (uint32_t part = 0; part < film.plan.parts.size(); ++part)
        if (const auto journal = readPartJournal(film, part, *fingerprint.value()))
            drawn += std::min<size_t>(journal.value().frameCount(), film.plan.parts[part].count);
    return uint32_t(drawn);
}

core::Result<std::vector<UnfinishedPart>> listUnfinishedParts(const Film& film) {
    const auto fingerprint = findDrawnFingerprint(film);
    if (!fingerprint)
        return fingerprint.error();
    std::vector<UnfinishedPart> unfinished;
    for (uint32_t part = 0; part < film.plan.parts.size(); ++part) {
        const FilmPart& frames = film.plan.parts[part];
        if (!fingerprint.value()) {
            unfinished.push_back({part, frames.first});
            continue;
        }
        const auto journal = readPartJournal(film, part, *fingerprint.value());
        if (!journal)
            return journal.error();
        for (uint32_t frame = frames.first; frame < frames.first + frames.count; ++frame)
            if (!journal.value().isComplete(
                    game::numberOfFrame(film.options, frame), game::fileOfFrame(film.options, frame)
                )) {
                unfinished.push_back({part, frame});
                break;
            }
    }
    return unfinished;
}

void removeWorkFiles(const Film& film) {
    std::error_code ignored;
    const auto partCount = uint32_t(film.plan.parts.size());
    for (uint32_t part = 0; part < partCount; ++part)
        fs::remove(partJournal(film.options.output, part), ignored);
    fs::remove(planFile(film.work), ignored);
    parts::removePartFiles(film.work, partCount);
}

} // namespace shutter::film
