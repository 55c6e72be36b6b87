// SPDX-License-Identifier: MIT
#include "game/sequence.h"

#include "engine/core/log.h"
#include "engine/core/progress.h"
#include "engine/gltf/gltf_loader.h"
#include "engine/io/content_hash.h"
#include "engine/io/image_file.h"
#include "game/film.h"
#include "game/flight.h"
#include "game/intermediates.h"
#include "game/method_renderer.h"
#include "game/sequence_journal.h"
#include "game/shot.h"
#include "game/statistics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <utility>
#include <vector>

namespace shutter::game {

namespace {

/// \return the files that were written
core::Result<std::vector<std::filesystem::path>>
writePicture(const RenderOptions& options, int frameNumber, const render::FrameResult& result) {
    const std::filesystem::path file = frameFile(options.out, frameNumber);
    std::vector<std::filesystem::path> files = {file};
    const image::Image& drawn = options.displayOut ? result.display : result.color;
    const image::Image picture = selectChannels(drawn, {{0, "R"}, {1, "G"}, {2, "B"}});
    if (core::Status written = io::writeImage(file, picture); !written)
        return written.error();
    for (const std::string& aov : options.aovs) {
        const auto found = result.intermediates.find(aov);
        if (found == result.intermediates.end()) {
            const core::Decision* blur =
                render::findDecision(result.statistics.explanations, "motion blur");
            core::logWarning(
                "--aov {} is not written: {}",
                aov,
                blur ? "motion blur was " + core::describe(*blur) : "one ray a pixel shows no error"
            );
            continue;
        }
        files.push_back(intermediateFile(file, aov));
        core::Status written = writeIntermediate(files.back(), aov, found->second);
        if (!written)
            return written.error();
    }
    return files;
}

/// `--explain`: what ran and what did not, a line each, in the order of the frame.
void printExplanations(double seconds, const render::FrameStatistics& statistics) {
    size_t width = 0;
    for (const render::Explanation& line : statistics.explanations)
        width = std::max(width, line.subject.size());
    fmt::print("frame at {} s\n", seconds);
    for (const render::Explanation& line : statistics.explanations)
        fmt::print(
            "  {:<6}  {:<{}}  {}, because {}\n",
            render::describe(line.kind),
            line.subject,
            width,
            line.decision.run ? "ran" : "skipped",
            line.decision.reason
        );
}

/// With --repeat, the picture drawn first warms the driver up and is not timed.
core::Result<render::FrameResult> renderRepeated(
    MethodRenderer& renderer, const RenderOptions& options, double seconds, core::Progress& progress
) {
    const auto onStep = [&] { progress.advance(); };
    auto result = renderer.renderPicture(seconds, onStep);
    if (options.repeat <= 1 || !result)
        return result;
    std::vector<render::FrameStatistics> frames;
    for (uint32_t i = 0; i < options.repeat; ++i) {
        result = renderer.renderPicture(seconds, onStep);
        if (!result)
            return result;
        frames.push_back(result.value().statistics);
    }
    result.value().statistics = computeMedian(frames);
    return result;
}

/// Of everything that a frame's picture depends on, but for its number. A film's frames are named
/// from the first on, so their names depend on that.
core::Result<std::string>
computeFingerprint(const RenderOptions& options, const gpu::DeviceInfo& device) {
    auto scene = gltf::computeSceneHash(options.scene);
    if (!scene)
        return scene.error();
    auto program = io::computeFileHash("/proc/self/exe");
    if (!program)
        return program.error();
    return io::computeContentHash(fmt::format(
        "scene {} program {} device {} {} flythrough {} clip {} fps {} first {} options {}",
        scene.value(),
        program.value(),
        device.name,
        device.driver,
        options.flythroughHash,
        options.flythroughClip,
        options.fps,
        options.film.empty() ? 0 : options.firstFrame,
        options.pictureOptions
    ));
}

/// Number in the file's name: a film's frames count from 0.
int fileNumber(const RenderOptions& options, size_t frame) {
    return static_cast<int>(frame) + (options.film.empty() ? options.firstFrame : 0);
}

/// Key in the journal.
int frameNumber(const RenderOptions& options, size_t frame) {
    return static_cast<int>(frame) + options.firstFrame;
}

/// What drawing alone tells makes frames that need not be drawn needed.
bool maySkip(const RenderOptions& options) {
    return !options.restart && options.stats.empty() && !options.explain && !options.dumpGraph &&
           options.repeat == 1;
}

/// A sequence on its way, with its journal; a single picture has none.
class Sequence {
  public:
    explicit Sequence(const RenderOptions& options) : mOptions(options) {}

    /// Error: the device cannot draw this. Nothing was written yet.
    core::Status prepare(gpu::Device& device, const Shot& shot) {
        mDrawing.emplace(device, shot.world.assets);
        auto created = MethodRenderer::create(device, *mDrawing, shot, mOptions);
        if (!created)
            return created.error();
        mRenderer = std::move(created).value();
        return {};
    }

    /// Looks for what an earlier run left, and says so.
    core::Status openJournal(const std::string& fingerprint) {
        auto opened = SequenceJournal::open(journalFile(mOptions.out), fingerprint);
        if (!opened)
            return opened.error();
        mJournal = std::move(opened).value();
        if (mJournal->before() == SequenceJournal::Before::OtherPictures)
            fmt::print(
                "{}: the frames on disk were drawn otherwise; all are drawn anew\n",
                mOptions.out.string()
            );
        if (!maySkip(mOptions))
            return {};
        for (size_t i = 0; i < mOptions.frameTimes.size(); ++i)
            mIsComplete.push_back(mJournal->isComplete(frameNumber(mOptions, i)));
        if (countComplete() > 0)
            fmt::print(
                "{}: {} of {} frames are complete on disk and skipped (--restart draws them)\n",
                mOptions.out.string(),
                countComplete(),
                mOptions.frameTimes.size()
            );
        return {};
    }

    /// Draws and writes what is not complete.
    core::Status draw() {
        const uint64_t draws = mOptions.repeat > 1 ? mOptions.repeat + 1 : 1;
        const size_t count = mOptions.frameTimes.size() - countComplete();
        if (count == 0)
            return {};
        core::Progress progress("rendering", count * mRenderer->stepsPerPicture() * draws);
        for (size_t i = 0; i < mOptions.frameTimes.size(); ++i)
            if (!isComplete(i))
                if (core::Status drawn = drawFrame(i, progress); !drawn)
                    return drawn;
        return {};
    }

    [[nodiscard]] const std::vector<PictureStatistics>& pictures() const { return mPictures; }

    [[nodiscard]] const std::optional<SequenceJournal>& journal() const { return mJournal; }

  private:
    [[nodiscard]] bool isComplete(size_t frame) const {
        return frame < mIsComplete.size() && mIsComplete[frame];
    }

    [[nodiscard]] size_t countComplete() const {
        return size_t(std::count(mIsComplete.begin(), mIsComplete.end(), true));
    }

    core::Status drawFrame(size_t frame, core::Progress& progress) {
        const double seconds = mOptions.frameTimes[frame];
        auto result = renderRepeated(*mRenderer, mOptions, seconds, progress);
        if (!result)
            return result.error();
        if (frame == 0 && mOptions.dumpGraph)
            fmt::print("{}", result.value().dump);
        if (mOptions.explain)
            printExplanations(seconds, result.value().statistics);
        const auto files = writePicture(mOptions, fileNumber(mOptions, frame), result.value());
        if (!files)
            return files.error();
        if (!mOptions.stats.empty())
            mPictures.push_back({seconds, result.value().statistics});
        return mJournal ? mJournal->add(frameNumber(mOptions, frame), files.value())
                        : core::Status();
    }

    const RenderOptions& mOptions;
    std::optional<render::Renderer> mDrawing;
    std::unique_ptr<MethodRenderer> mRenderer;
    std::optional<SequenceJournal> mJournal;
    std::vector<bool> mIsComplete; ///< one a frame; empty: none is
    std::vector<PictureStatistics> mPictures;
};

/// The film's own journal: the film is its one frame.
core::Result<SequenceJournal> openFilmJournal(
    const io::VideoEncoder& encoder, const RenderOptions& options, const std::string& fingerprint
) {
    return SequenceJournal::open(
        journalFile(options.film),
        io::computeContentHash(fmt::format(
            "{} frames {} {} {} {}",
            fingerprint,
            options.firstFrame,
            options.frameTimes.size(),
            encoder.version,
            encoder.codec
        ))
    );
}

core::Status renderFilm(
    const io::VideoEncoder& encoder,
    const RenderOptions& options,
    const std::string& fingerprint,
    Sequence& sequence
) {
    auto journal = openFilmJournal(encoder, options, fingerprint);
    if (!journal)
        return journal.error();
    if (maySkip(options) && journal.value().isComplete(0)) {
        fmt::print("{}: is complete and skipped (--restart draws it)\n", options.film.string());
        if (options.keepFrames && !std::filesystem::exists(options.out.parent_path()))
            core::logWarning("--keep-frames: its frames are gone; --restart draws them");
        return {};
    }
    if (core::Status made = makeFilmFolder(options); !made)
        return made;
    if (core::Status opened = sequence.openJournal(fingerprint); !opened)
        return opened;
    if (core::Status drawn = sequence.draw(); !drawn)
        return drawn;
    if (core::Status encoded = encodeFilm(encoder, options); !encoded)
        return encoded;
    // Known to be complete before its frames go: a run that ends here draws nothing again.
    if (core::Status added = journal.value().add(0, {options.film}); !added)
        return added;
    removeFilmFrames(options, sequence.journal()->file());
    return {};
}

} // namespace

core::Status renderSequence(
    RenderOptions options, const std::optional<io::VideoEncoder>& encoder, gpu::Device& device
) {
    auto shot = loadShot(options);
    if (!shot)
        return shot.error();
    if (core::Status planned = planClipFrames(shot.value().world, options); !planned)
        return planned;
    Sequence sequence(options);
    if (core::Status prepared = sequence.prepare(device, shot.value()); !prepared)
        return prepared;
    core::Status drawn;
    if (options.isSequence) {
        const auto fingerprint = computeFingerprint(options, device.info());
        if (!fingerprint)
            return fingerprint.error();
        if (encoder)
            drawn = renderFilm(*encoder, options, fingerprint.value(), sequence);
        else if (core::Status opened = sequence.openJournal(fingerprint.value()); !opened)
            drawn = opened;
        else
            drawn = sequence.draw();
    } else {
        drawn = sequence.draw();
    }
    if (!drawn || options.stats.empty())
        return drawn;
    return writeStatistics(options.stats, options, device.info(), sequence.pictures());
}

} // namespace shutter::game
