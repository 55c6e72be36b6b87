// SPDX-License-Identifier: MIT
#include "game/film/film_part.h"

#include "engine/gpu/device.h"
#include "engine/io/file_bytes.h"
#include "game/options/program.h"
#include "game/output/fingerprint.h"
#include "game/output/sequence.h"
#include "game/output/sequence_journal.h"
#include "game/parts/part_commands.h"
#include "game/parts/part_device.h"

#include <system_error>
#include <utility>

namespace shutter::film {

namespace fs = std::filesystem;

using core::makeError;

namespace {

/// Tells of no device: the film is known to be finished on machines that cannot draw it.
std::string computeFilmFingerprint(const Film& film) {
    return io::computeContentHash(fmt::format(
        "{} frames {} {} in parts codec {} {}",
        film.plan.fingerprint,
        film.options.shot.firstFrame,
        film.plan.frameCount(),
        int(film.options.output.video.codec),
        film.options.output.video.timecode
    ));
}

core::Status checkComplete(const Film& film) {
    const auto unfinished = listUnfinishedParts(film);
    if (!unfinished)
        return unfinished.error();
    if (unfinished.value().empty())
        return {};
    const UnfinishedPart& first = unfinished.value().front();
    return makeError(
        "part {} is not complete: frame {} is missing, '{}'",
        first.part,
        game::numberOfFrame(film.options, first.frame),
        game::fileOfFrame(film.options, first.frame).string()
    );
}

/// Records the frames where `shutter render` looks for them.
core::Status recordFrames(const Film& film) {
    const auto fingerprint = findDrawnFingerprint(film);
    if (!fingerprint)
        return fingerprint.error();
    SHUTTER_CHECK(fingerprint.value().has_value(), "complete frames were drawn by a device");
    auto whole = game::SequenceJournal::open(
        game::journalFile(film.options.output.out), *fingerprint.value()
    );
    if (!whole)
        return whole.error();
    for (uint32_t part = 0; part < film.plan.parts.size(); ++part) {
        const FilmPart& frames = film.plan.parts[part];
        const auto journal = game::SequenceJournal::read(
            partJournal(film.options.output, part), *fingerprint.value()
        );
        if (!journal)
            return journal.error();
        for (uint32_t frame = frames.first; frame < frames.first + frames.count; ++frame)
            SHUTTER_TRY(
                whole.value().addFrom(journal.value(), game::numberOfFrame(film.options, frame))
            );
    }
    return {};
}

} // namespace

core::Status drawPart(Film film, uint32_t part, const std::string& deviceName) {
    SHUTTER_TRY(parts::checkPart(part, film.plan.parts.size(), kFilmNoun));
    auto shot = loadPlannedShot(film);
    if (!shot)
        return shot.error();
    gpu::DeviceOptions deviceOptions = film.options.device;
    if (!deviceName.empty())
        deviceOptions.wanted = deviceName;
    deviceOptions.cacheFolder = game::findCacheFolder();
    auto device = gpu::Device::create(deviceOptions);
    if (!device)
        return device.error();
    const gpu::DeviceInfo& info = device.value()->info();
    SHUTTER_TRY(
        parts::settleDevice(parts::deviceFile(film.work), {info.name, info.driver}, kFilmNoun)
    );
    const FilmPart& frames = film.plan.parts[part];
    SHUTTER_TRY(game::drawFrames(
        film.options,
        shot.value(),
        {frames.first, frames.count, partJournal(film.options.output, part)},
        game::addDevice(film.plan.fingerprint, info.name, info.driver),
        *device.value()
    ));
    if (const uint32_t messages = device.value()->validationMessageCount(); messages > 0)
        return makeError("{} Vulkan validation messages", messages);
    return {};
}

bool isFilmFinished(const Film& film) {
    const fs::path& file = film.options.output.film;
    if (file.empty())
        return false;
    const auto record =
        game::SequenceJournal::read(game::journalFile(file), computeFilmFingerprint(film));
    return record && record.value().isComplete(0, file);
}

core::Status finishFilm(Film film) {
    const auto shot = loadPlannedShot(film);
    if (!shot)
        return shot.error();
    SHUTTER_TRY(checkComplete(film));
    const game::OutputOptions& output = film.options.output;
    if (!output.film.empty()) {
        const auto encoder = game::prepareFilm(film.options);
        if (!encoder)
            return encoder.error();
        // The film's own journal: the film is its one frame.
        auto record = game::SequenceJournal::open(
            game::journalFile(output.film), computeFilmFingerprint(film)
        );
        if (!record)
            return record.error();
        SHUTTER_TRY(game::encodeFilm(encoder.value(), film.options));
        SHUTTER_TRY(record.value().add(0, {output.film}));
    }
    if (output.film.empty() || output.keepFrames)
        SHUTTER_TRY(recordFrames(film));
    removeWork(film);
    return {};
}

parts::PartWork describeWork(const Film& film) {
    const fs::path& file = film.options.output.film;
    parts::PartWork work;
    work.noun = kFilmNoun;
    work.verb = "rendering";
    work.name = (file.empty() ? film.options.output.out : file).filename().string();
    work.folder = film.work;
    work.start = film.plan.folder;
    work.partCommand = kPartCommand;
    work.finishCommand = kFinishCommand;
    work.stepCount = film.plan.frameCount();
    work.countDone = [&film] { return countDrawnFrames(film); };
    work.isFinished = [&film] {
        // A sequence of pictures has no film to look for: the job that finishes it removes the
        // plan.
        std::error_code ignored;
        return film.options.output.film.empty() ? !fs::exists(planFile(film.work), ignored)
                                                : isFilmFinished(film);
    };
    work.listUnfinished = [&film]() -> core::Result<std::vector<uint32_t>> {
        const auto unfinished = listUnfinishedParts(film);
        if (!unfinished)
            return unfinished.error();
        std::vector<uint32_t> parts;
        for (const UnfinishedPart& part : unfinished.value())
            parts.push_back(part.part);
        return parts;
    };
    return work;
}

void removeWork(const Film& film) {
    removeWorkFiles(film);
    std::error_code ignored;
    if (!film.options.output.film.empty())
        game::removeFilmFrames(film.options, game::journalFile(film.options.output.out));
    else
        fs::remove(film.work, ignored);
}

} // namespace shutter::film
