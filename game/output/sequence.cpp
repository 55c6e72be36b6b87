// SPDX-License-Identifier: MIT
#include "game/output/sequence.h"

#include "engine/core/log.h"
#include "engine/core/progress.h"
#include "engine/core/result.h"
#include "engine/core/words.h"
#include "engine/gltf/gltf_loader.h"
#include "engine/gpu/device_select.h"
#include "engine/io/file_bytes.h"
#include "engine/io/image_file.h"
#include "engine/scene/auto_focus.h"
#include "engine/scene/lens.h"
#include "game/output/extra_files.h"
#include "game/output/render_options.h"
#include "game/output/sequence_journal.h"
#include "game/shot/picture_drawer.h"
#include "game/shot/picture_effects.h"
#include "game/shot/shot.h"
#include "game/shot/surroundings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

namespace shutter::game {

namespace {

/// Why an intermediate that the method has is not one of a frame's; continues "because".
std::string
explainMissing(const std::string& aov, const std::vector<render::Explanation>& explanations) {
    const core::Decision* blur = render::findDecision(explanations, "motion blur");
    if (!blur)
        return "one ray per pixel shows no error";
    if (!blur->run)
        return "motion blur was skipped: " + blur->reason;
    if (aov == "last")
        return "the effect holds no frame before this one";
    if (aov == "second")
        return "the setting secondRaster is off";
    const core::Decision* rays = render::findDecision(explanations, "ray reveal");
    return rays && !rays->run ? "no rays were traced: " + rays->reason
                              : "motion blur did without it";
}

/// \return the files that were written
core::Result<std::vector<std::filesystem::path>>
writePicture(const RenderOptions& options, size_t frame, const render::FrameResult& result) {
    const std::filesystem::path file = fileOfFrame(options, frame);
    const auto stamp = findStamp(options, frame);
    if (!stamp)
        return stamp.error();
    std::vector<std::filesystem::path> files = {file};
    const bool isDisplay = options.output.displayOut && !options.output.isDeep();
    const image::Image& drawn = isDisplay ? result.display : result.color;
    constexpr Channel kColor[] = {{0, "R"}, {1, "G"}, {2, "B"}};
    const image::Image picture = selectChannels(drawn, kColor);
    if (options.output.isDeep()) // the device's display pictures have 8 bits
        SHUTTER_TRY(io::writeDeepPng(
            file, tonemap::computeDisplayImage(picture, options.shot.picture.tonemap)
        ));
    else if (stamp.value() && !options.output.displayOut)
        SHUTTER_TRY(io::writeStampedImage(file, picture, *stamp.value()));
    else
        SHUTTER_TRY(io::writeImage(file, picture));
    for (const std::string& aov : options.output.aovs) {
        const auto found = result.intermediates.find(aov);
        if (found == result.intermediates.end()) {
            core::logWarning(
                "--aov {} is not written, because {}",
                aov,
                explainMissing(aov, result.statistics.explanations)
            );
            continue;
        }
        files.push_back(intermediateFile(file, aov));
        SHUTTER_TRY(writeIntermediate(files.back(), aov, found->second, stamp.value()));
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

/// Data that only drawing provides makes otherwise complete frames necessary.
bool maySkip(const RenderOptions& options) {
    return !options.output.restart && options.output.stats.empty() && !options.output.explain &&
           !options.output.dumpGraph && options.output.repeat == 1;
}

/// The journal of a part, next to that of the whole.
std::filesystem::path partJournal(const std::filesystem::path& whole, uint32_t part) {
    return whole.string() + fmt::format(".part_{}", part + 1);
}

/// Those that are there.
std::vector<std::filesystem::path> listPartJournals(const std::filesystem::path& whole) {
    std::error_code ignored;
    const std::filesystem::path folder = whole.has_parent_path() ? whole.parent_path() : ".";
    const std::string prefix = whole.filename().string() + ".part_";
    std::vector<std::filesystem::path> journals;
    for (const auto& entry : std::filesystem::directory_iterator(folder, ignored))
        if (const std::string name = entry.path().filename().string(); name.starts_with(prefix))
            journals.push_back(whole.parent_path() / name);
    return journals;
}

/// A sequence on its way, with its journal; a single picture has none.
class Sequence {
  public:
    /// \param options their frames are planned
    explicit Sequence(const RenderOptions& options) : mOptions(options) {
        const FramePart part = options.output.part.value_or(FramePart());
        for (size_t i = part.index; i < options.shot.frameTimes.size(); i += part.count)
            mFrames.push_back(i);
    }

    /// Error: the device cannot draw this. Nothing was written yet.
    core::Status prepare(gpu::Device& device, Shot& shot) {
        const ShotOptions& size = mOptions.shot;
        core::Status able = PictureDrawer::check(device, mOptions.method, size.width, size.height);
        if (!able)
            return able;
        mDevice = &device;
        mShot = &shot;
        mRenderer.emplace(device, shot.world.assets);
        mEffects.emplace(device).configure(mOptions.shot.picture);
        mDrawer.emplace(device, *mRenderer);
        return {};
    }

    /// Reads the journals of earlier runs and other processes, and reports them.
    core::Status openJournal(const std::string& fingerprint) {
        const OutputOptions& output = mOptions.output;
        const std::filesystem::path whole = journalFile(output.out);
        const std::filesystem::path own =
            output.part ? partJournal(whole, output.part->index) : whole;
        mPartJournals = listPartJournals(whole);
        std::vector<std::filesystem::path> files = mPartJournals;
        if (output.part)
            files.push_back(whole);
        std::vector<SequenceJournal> others;
        for (const std::filesystem::path& file : files) {
            auto other = readOther(file, fingerprint);
            if (!other)
                return other.error();
            others.push_back(std::move(other).value());
        }
        auto opened = SequenceJournal::open(own, fingerprint);
        if (!opened)
            return opened.error();
        mJournal = std::move(opened).value();
        if (mJournal->before() == SequenceJournal::Before::OtherPictures)
            fmt::print(
                "{}: the frames on disk were drawn otherwise; all are drawn again\n",
                output.out.string()
            );
        if (!maySkip(mOptions))
            return {};
        for (const size_t frame : mFrames) {
            const auto complete = takeFrame(others, frame);
            if (!complete)
                return complete.error();
            mIsComplete.push_back(complete.value());
        }
        if (countComplete() > 0)
            fmt::print(
                "{}: {} of {} complete on disk and skipped (--restart draws {})\n",
                output.out.string(),
                countComplete(),
                core::countOf(
                    mFrames.size(), "frame is", countComplete() == 1 ? "frames is" : "frames are"
                ),
                countComplete() == 1 ? "it" : "them"
            );
        return {};
    }

    /// Call after the whole's journal has merged their entries.
    void removePartJournals() const {
        std::error_code ignored;
        for (const std::filesystem::path& journal : mPartJournals)
            std::filesystem::remove(journal, ignored);
    }

    /// Draws and writes incomplete frames.
    core::Status draw() {
        bool hasKeptPipelines = false;
        const uint64_t draws = mOptions.output.repeat > 1 ? mOptions.output.repeat + 1 : 1;
        const size_t count = mFrames.size() - countComplete();
        if (count == 0)
            return {};
        core::Progress progress(
            "rendering",
            count * PictureDrawer::countSteps(mOptions.method, mOptions.shot.picture.antiAliasing) *
                draws
        );
        // A part's goes into the log of a scheduler, which knows the progress of the whole.
        if (mOptions.shot.isSequence && !mOptions.output.part)
            progress.printLines();
        for (size_t i = 0; i < mFrames.size(); ++i)
            if (mIsComplete.empty() || !mIsComplete[i]) {
                SHUTTER_TRY(drawFrame(mFrames[i], progress));
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
        const extract::ViewRequest& view = request.frame.view;
        scene::replayAutoFocus(mShot->world, view.camera, view.exposure);
        request.frame.intermediates = mOptions.output.aovs;
        request.frame.wantColor = !mOptions.output.displayOut || mOptions.output.isDeep();
        request.frame.wantDisplay = !request.frame.wantColor;
        request.frame.wantDump = mOptions.output.dumpGraph;
        request.frame.wantTrace = !mOptions.output.hashPasses.empty();
        request.frame.wantReasons = mOptions.output.explain;
        request.ending = mEffects->listWith({});
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

    /// Reads the journal of another process. Error: its pictures were drawn with other settings or
    /// by another driver, and do not belong to this film.
    [[nodiscard]] core::Result<SequenceJournal>
    readOther(const std::filesystem::path& file, const std::string& fingerprint) const {
        auto other = SequenceJournal::read(file, fingerprint);
        if (!other || other.value().before() != SequenceJournal::Before::OtherPictures)
            return other;
        if (!mOptions.output.restart)
            return core::makeError(
                "--out: frames of '{}' were drawn otherwise: with other options, of another scene, "
                "or by another program, device or driver; --restart draws all anew",
                mOptions.output.out.string()
            );
        std::error_code ignored;
        std::filesystem::remove(file, ignored);
        return other;
    }

    /// Whether the frame is complete; then it is in the own journal, too.
    core::Result<bool> takeFrame(const std::vector<SequenceJournal>& others, size_t frame) {
        const int number = numberOfFrame(mOptions, frame);
        const std::filesystem::path file = fileOfFrame(mOptions, frame);
        if (mJournal->isComplete(number, file))
            return true;
        for (const SequenceJournal& other : others)
            if (other.isComplete(number, file)) {
                SHUTTER_TRY(mJournal->addFrom(other, number));
                return true;
            }
        return false;
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
    std::vector<size_t> mFrames; ///< those to be drawn: indices among the shot's frame times
    gpu::Device* mDevice = nullptr;
    Shot* mShot = nullptr;
    std::optional<render::Renderer> mRenderer;
    std::optional<PictureEffects> mEffects;
    std::optional<PictureDrawer> mDrawer;
    std::optional<SequenceJournal> mJournal;
    std::vector<std::filesystem::path> mPartJournals;
    std::vector<bool> mIsComplete; ///< one for each of `mFrames`; empty: none is
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
            "{} is complete, so it is skipped (--restart draws it)\n", options.output.film.string()
        );
        if (options.output.keepFrames && !std::filesystem::exists(options.output.out.parent_path()))
            core::logWarning("--keep-frames: its frames are gone; --restart draws them");
        return {};
    }
    SHUTTER_TRY(makeFilmFolder(options));
    SHUTTER_TRY(sequence.openJournal(fingerprint));
    SHUTTER_TRY(sequence.draw());
    if (options.output.part)
        return {};
    SHUTTER_TRY(encodeFilm(encoder, options));
    // Known to be complete before its frames go: a run that ends here draws nothing again.
    SHUTTER_TRY(journal.value().add(0, {options.output.film}));
    sequence.removePartJournals();
    removeFilmFrames(options, sequence.journal()->file());
    return {};
}

core::Status
drawPictures(const RenderOptions& options, const std::string& fingerprint, Sequence& sequence) {
    SHUTTER_TRY(sequence.openJournal(fingerprint));
    SHUTTER_TRY(sequence.draw());
    if (!options.output.part)
        sequence.removePartJournals();
    return {};
}

// Hash of all inputs of a sequence's pictures: two frames of equal numbers and fingerprints are the
// same bits.

/// Hashes everything that a frame's picture depends on except its number and the device: the
/// options, the contents of the files that they name, and this program. A film's frames are named
/// from the first on, so their names depend on that.
/// \param shot loaded from `options.shot`
/// Error: a file cannot be read; names it.
core::Result<std::string> computeFingerprint(const RenderOptions& options, const Shot& shot) {
    auto scene = gltf::computeSceneHash(options.shot.scene, options.shot.reach);
    if (!scene)
        return scene.error();
    auto program = io::computeFileHash("/proc/self/exe");
    if (!program)
        return program.error();
    auto surroundings = computeSurroundingsHash(options.shot.environment);
    if (!surroundings)
        return surroundings.error();
    return io::computeContentHash(fmt::format(
        "scene {} surroundings {} program {} flythrough {} clip {} fps {} first {} framed {} "
        "options {}",
        scene.value(),
        surroundings.value(),
        program.value(),
        options.shot.flythroughHash,
        options.shot.flythroughClip,
        core::describe(options.shot.fps),
        options.output.film.empty() ? 0 : options.shot.firstFrame,
        shot.framedAt ? fmt::format("at {}", *shot.framedAt) : "by none",
        options.fingerprint
    ));
}

/// Warns where the method draws a pinhole although the camera has a lens. Error: the method cannot
/// determine the number of samples for the lens.
core::Status checkLensOf(const Shot& shot, const MethodOptions& options) {
    if (!scene::hasLens(shot.world, shot.camera))
        return {};
    if (options.maxStepPx)
        return core::makeError("--instants auto measures motion, not what the lens blurs: leave it "
                               "out, or give --fstop 0");
    if (!options.method->hasLens)
        core::logWarning(
            "method {} draws the camera as a pinhole: only {} have a lens",
            options.method->name,
            listLensMethods("and")
        );
    return {};
}

/// The fingerprint of the same pictures drawn by this device and its driver.
std::string
addDevice(const std::string& fingerprint, const std::string& device, const std::string& driver) {
    return io::computeContentHash(fmt::format("{} device {} {}", fingerprint, device, driver));
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

core::Status renderSequence(
    RenderOptions options, const std::optional<io::VideoEncoder>& encoder, gpu::Device& device
) {
    auto shot = loadShot(options.shot);
    if (!shot)
        return shot.error();
    SHUTTER_TRY(planClipFrames(shot.value().world, options.shot));
    SHUTTER_TRY(checkLensOf(shot.value(), options.method));
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
        else
            drawn = drawPictures(options, fingerprint, sequence);
    } else {
        drawn = sequence.draw();
    }
    if (!drawn || options.output.stats.empty())
        return drawn;
    return writeStatistics(options.output.stats, options, device.info(), sequence.pictures());
}

} // namespace shutter::game
