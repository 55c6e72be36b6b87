// SPDX-License-Identifier: MIT
#include "game/output/sequence.h"

#include "engine/core/log.h"
#include "engine/core/progress.h"
#include "engine/io/file_bytes.h"
#include "engine/io/image_file.h"
#include "game/output/extra_files.h"
#include "game/output/fingerprint.h"
#include "game/output/sequence_journal.h"
#include "game/output/timecode.h"
#include "game/shot/picture_drawer.h"
#include "game/shot/shot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <utility>
#include <vector>

namespace shutter::game {

namespace {

/// \return the files that were written
core::Result<std::vector<std::filesystem::path>>
writePicture(const RenderOptions& options, size_t frame, const render::FrameResult& result) {
    const std::filesystem::path file = fileOfFrame(options, frame);
    const auto timecode = findTimecode(options, frame);
    if (!timecode)
        return timecode.error();
    std::vector<std::filesystem::path> files = {file};
    const bool isDisplay = options.output.displayOut && !options.output.isDeep();
    const image::Image& drawn = isDisplay ? result.display : result.color;
    const image::Image picture = selectChannels(drawn, {{0, "R"}, {1, "G"}, {2, "B"}});
    if (options.output.isDeep()) // the device's display pictures have 8 bits
        SHUTTER_TRY(
            io::writeDeepPng(file, tonemap::computeDisplayImage(picture, options.shot.tonemap))
        );
    else if (timecode.value() && !options.output.displayOut)
        SHUTTER_TRY(io::writeImageWithTimecode(file, picture, *timecode.value()));
    else
        SHUTTER_TRY(io::writeImage(file, picture));
    for (const std::string& aov : options.output.aovs) {
        const auto found = result.intermediates.find(aov);
        if (found == result.intermediates.end()) {
            const core::Decision* blur =
                render::findDecision(result.statistics.explanations, "motion blur");
            core::logWarning(
                "--aov {} is not written: {}",
                aov,
                blur ? "motion blur was " + core::describe(*blur)
                     : "one ray per pixel shows no error"
            );
            continue;
        }
        files.push_back(intermediateFile(file, aov));
        SHUTTER_TRY(writeIntermediate(files.back(), aov, found->second, timecode.value()));
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

/// What drawing alone tells makes frames that need not be drawn needed.
bool maySkip(const RenderOptions& options) {
    return !options.output.restart && options.output.stats.empty() && !options.output.explain &&
           !options.output.dumpGraph && options.output.repeat == 1;
}

/// A sequence on its way, with its journal; a single picture has none.
class Sequence {
  public:
    explicit Sequence(const RenderOptions& options)
        : mOptions(options), mCount(options.shot.frameTimes.size()) {}

    /// \param part draws this alone
    Sequence(const RenderOptions& options, const FramePart& part)
        : mOptions(options), mFirst(part.first), mCount(part.count) {}

    /// Error: the device cannot draw this. Nothing was written yet.
    core::Status prepare(gpu::Device& device, const Shot& shot) {
        const ShotOptions& size = mOptions.shot;
        core::Status able = PictureDrawer::check(device, mOptions.method, size.width, size.height);
        if (!able)
            return able;
        mDevice = &device;
        mShot = &shot;
        mRenderer.emplace(device, shot.world.assets);
        mBloom.emplace(device, mOptions.shot.bloom);
        mTonemap.emplace(device, mOptions.shot.tonemap);
        mDrawer.emplace(device, *mRenderer);
        return {};
    }

    /// Looks for what an earlier run left, and says so.
    core::Status openJournal(const std::filesystem::path& file, const std::string& fingerprint) {
        auto opened = SequenceJournal::open(file, fingerprint);
        if (!opened)
            return opened.error();
        mJournal = std::move(opened).value();
        if (mJournal->before() == SequenceJournal::Before::OtherPictures)
            fmt::print(
                "{}: the frames on disk were drawn otherwise; all are drawn anew\n",
                mOptions.output.out.string()
            );
        if (!maySkip(mOptions))
            return {};
        for (size_t i = mFirst; i < mFirst + mCount; ++i)
            mIsComplete.push_back(
                mJournal->isComplete(numberOfFrame(mOptions, i), fileOfFrame(mOptions, i))
            );
        if (countComplete() > 0)
            fmt::print(
                "{}: {} of {} frames are complete on disk and skipped (--restart draws them)\n",
                mOptions.output.out.string(),
                countComplete(),
                mCount
            );
        return {};
    }

    /// Takes over what an unbroken run left of the part.
    core::Status takeFrames(const SequenceJournal& whole) {
        for (size_t i = mFirst; i < mFirst + mCount; ++i) {
            const int number = numberOfFrame(mOptions, i);
            const std::filesystem::path file = fileOfFrame(mOptions, i);
            if (mJournal->isComplete(number, file) || !whole.isComplete(number, file))
                continue;
            SHUTTER_TRY(mJournal->addFrom(whole, number));
            mIsComplete[i - mFirst] = true;
        }
        return {};
    }

    /// Draws and writes what is not complete.
    core::Status draw() {
        bool hasKeptPipelines = false;
        const uint64_t draws = mOptions.output.repeat > 1 ? mOptions.output.repeat + 1 : 1;
        const size_t count = mCount - countComplete();
        if (count == 0)
            return {};
        core::Progress progress(
            "rendering",
            count * PictureDrawer::countSteps(mOptions.method, mOptions.shot.antiAliasing) * draws
        );
        for (size_t i = mFirst; i < mFirst + mCount; ++i)
            if (!isComplete(i)) {
                SHUTTER_TRY(drawFrame(i, progress));
                if (count > 1 && !std::exchange(hasKeptPipelines, true))
                    mDevice->savePipelineCache(); // a long sequence may be stopped at any frame
            }
        return {};
    }

    [[nodiscard]] const std::vector<PictureStatistics>& pictures() const { return mPictures; }

    [[nodiscard]] const std::optional<SequenceJournal>& journal() const { return mJournal; }

  private:
    core::Result<render::FrameResult> drawOnce(double seconds, core::Progress& progress) {
        PictureRequest request = makePicture(*mShot, mOptions.shot, mOptions.method, seconds);
        request.frame.intermediates = mOptions.output.aovs;
        request.frame.wantColor = !mOptions.output.displayOut || mOptions.output.isDeep();
        request.frame.wantDisplay = !request.frame.wantColor;
        request.frame.wantDump = mOptions.output.dumpGraph;
        request.frame.wantTrace = !mOptions.output.hashPasses.empty();
        request.frame.wantReasons = mOptions.output.explain;
        request.ending = {&*mBloom, &*mTonemap};
        return mDrawer->draw(mShot->world, request, [&] { progress.advance(); });
    }

    /// With --repeat, the picture drawn first warms the driver up and is not timed.
    core::Result<render::FrameResult> drawRepeated(double seconds, core::Progress& progress) {
        auto result = drawOnce(seconds, progress);
        if (mOptions.output.repeat <= 1 || !result)
            return result;
        std::vector<render::FrameStatistics> frames;
        for (uint32_t i = 0; i < mOptions.output.repeat; ++i) {
            result = drawOnce(seconds, progress);
            if (!result)
                return result;
            frames.push_back(result.value().statistics);
        }
        result.value().statistics = render::computeMedian(frames);
        return result;
    }

    [[nodiscard]] bool isComplete(size_t frame) const {
        return !mIsComplete.empty() && mIsComplete[frame - mFirst];
    }

    [[nodiscard]] size_t countComplete() const {
        return size_t(std::count(mIsComplete.begin(), mIsComplete.end(), true));
    }

    core::Status drawFrame(size_t frame, core::Progress& progress) {
        const double seconds = mOptions.shot.frameTimes[frame];
        auto result = drawRepeated(seconds, progress);
        if (!result)
            return result.error();
        if (frame == 0 && mOptions.output.dumpGraph)
            fmt::print("{}", result.value().dump);
        if (mOptions.output.explain)
            printExplanations(seconds, result.value().statistics);
        if (!mOptions.output.hashPasses.empty())
            SHUTTER_TRY(
                writePassHashes(mOptions.output.hashPasses, mDevice->info(), result.value().trace)
            );
        const auto files = writePicture(mOptions, frame, result.value());
        if (!files)
            return files.error();
        if (!mOptions.output.stats.empty())
            mPictures.push_back({seconds, result.value().statistics});
        return mJournal ? mJournal->add(numberOfFrame(mOptions, frame), files.value())
                        : core::Status();
    }

    const RenderOptions& mOptions;
    size_t mFirst = 0; ///< of the frames that are drawn
    size_t mCount = 0;
    gpu::Device* mDevice = nullptr;
    const Shot* mShot = nullptr;
    std::optional<render::Renderer> mRenderer;
    std::optional<bloom::Bloom> mBloom;
    std::optional<tonemap::Tonemap> mTonemap;
    std::optional<PictureDrawer> mDrawer;
    std::optional<SequenceJournal> mJournal;
    std::vector<bool> mIsComplete; ///< one per frame that is drawn; empty: none is
    std::vector<PictureStatistics> mPictures;
};

/// The film's own journal: the film is its one frame.
core::Result<SequenceJournal> openFilmJournal(
    const io::VideoEncoder& encoder, const RenderOptions& options, const std::string& fingerprint
) {
    return SequenceJournal::open(
        journalFile(options.output.film),
        io::computeContentHash(fmt::format(
            "{} frames {} {} {} {} {}",
            fingerprint,
            options.shot.firstFrame,
            options.shot.frameTimes.size(),
            encoder.version,
            encoder.codec,
            encoder.format.timecode
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
    if (maySkip(options) && journal.value().isComplete(0, options.output.film)) {
        fmt::print(
            "{}: is complete and skipped (--restart draws it)\n", options.output.film.string()
        );
        if (options.output.keepFrames && !std::filesystem::exists(options.output.out.parent_path()))
            core::logWarning("--keep-frames: its frames are gone; --restart draws them");
        return {};
    }
    SHUTTER_TRY(makeFilmFolder(options));
    SHUTTER_TRY(sequence.openJournal(journalFile(options.output.out), fingerprint));
    SHUTTER_TRY(sequence.draw());
    SHUTTER_TRY(encodeFilm(encoder, options));
    // Known to be complete before its frames go: a run that ends here draws nothing again.
    SHUTTER_TRY(journal.value().add(0, {options.output.film}));
    removeFilmFrames(options, sequence.journal()->file());
    return {};
}

} // namespace

std::filesystem::path fileOfFrame(const RenderOptions& options, size_t frame) {
    const int number = static_cast<int>(frame);
    return frameFile(
        options.output.out, options.output.film.empty() ? number + options.shot.firstFrame : number
    );
}

int numberOfFrame(const RenderOptions& options, size_t frame) {
    return static_cast<int>(frame) + options.shot.firstFrame;
}

core::Status drawFrames(
    const RenderOptions& options,
    const Shot& shot,
    const FramePart& part,
    const std::string& fingerprint,
    gpu::Device& device
) {
    SHUTTER_CHECK(
        part.first + part.count <= options.shot.frameTimes.size(),
        "frames {} and {} more",
        part.first,
        part.count
    );
    Sequence sequence(options, part);
    SHUTTER_TRY(sequence.prepare(device, shot));
    SHUTTER_TRY(sequence.openJournal(part.journal, fingerprint));
    const auto whole = SequenceJournal::read(journalFile(options.output.out), fingerprint);
    if (!whole)
        return whole.error();
    SHUTTER_TRY(sequence.takeFrames(whole.value()));
    return sequence.draw();
}

core::Status renderSequence(
    RenderOptions options, const std::optional<io::VideoEncoder>& encoder, gpu::Device& device
) {
    auto shot = loadShot(options.shot);
    if (!shot)
        return shot.error();
    SHUTTER_TRY(planClipFrames(shot.value().world, options.shot));
    Sequence sequence(options);
    SHUTTER_TRY(sequence.prepare(device, shot.value()));
    core::Status drawn;
    if (options.shot.isSequence) {
        const auto pictures = computeFingerprint(options, shot.value());
        if (!pictures)
            return pictures.error();
        const gpu::DeviceInfo& drawing = device.info();
        const std::string fingerprint = addDevice(pictures.value(), drawing.name, drawing.driver);
        if (encoder)
            drawn = renderFilm(*encoder, options, fingerprint, sequence);
        else if (core::Status opened =
                     sequence.openJournal(journalFile(options.output.out), fingerprint);
                 !opened)
            drawn = opened;
        else
            drawn = sequence.draw();
    } else {
        drawn = sequence.draw();
    }
    if (!drawn || options.output.stats.empty())
        return drawn;
    return writeStatistics(options.output.stats, options, device.info(), sequence.pictures());
}

} // namespace shutter::game
