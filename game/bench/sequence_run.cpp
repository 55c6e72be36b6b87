// SPDX-License-Identifier: MIT
#include "game/bench/sequence_run.h"

#include "engine/core/parallel_jobs.h"
#include "engine/gltf/gltf_loader.h"
#include "engine/io/file_bytes.h"
#include "engine/io/image_file.h"
#include "game/bench/frame_judge.h"
#include "game/bench/sequence/sequence_source.h"
#include "game/bench/sequence_pass.h"
#include "game/options/shot_arguments.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <system_error>
#include <utility>

namespace shutter::bench {

namespace {

namespace fs = std::filesystem;
using core::Status;

core::Result<std::string> computeSequenceHash(
    const SequenceCase& film,
    const SequenceFiles& files,
    const SequenceOptions& options,
    const gpu::DeviceInfo& device
) {
    const auto scene = gltf::computeSceneHash(files.scene);
    if (!scene)
        return scene.error();
    const auto program = io::computeFileHash("/proc/self/exe");
    if (!program)
        return program.error();
    return io::computeContentHash(fmt::format(
        "sequence {} scene {} script {} program {} device {} {} frames {} {} truth {} {} {}",
        film.name,
        scene.value(),
        io::computeContentHash(std::string(film.script)),
        program.value(),
        device.name,
        device.driver,
        film.firstFrame,
        options.frames,
        options.truth.maxStepPx,
        options.truth.mostInstants,
        game::describe(film.shot)
    ));
}

/// One sequence on its way, with its journal.
class SequenceRun {
  public:
    SequenceRun(
        gpu::Device& device,
        const SequenceCase& film,
        const SequenceFiles& files,
        SequencePlan plan,
        const SequenceOptions& options,
        const std::string& hash,
        core::Progress& progress,
        const StopQuestion& stop
    )
        : mDevice(device), mFilm(film), mFiles(files), mPlan(std::move(plan)), mOptions(options),
          mProgress(progress), mStop(stop),
          mJournal(options.folder / "journal" / (film.name + ".json"), hash),
          mFrames(options.folder / "frames" / film.name) {}

    Status run() {
        SHUTTER_TRY(drawOwn());
        if (!mStop())
            SHUTTER_TRY(drawStanding());
        if (!mStop())
            SHUTTER_TRY(makeFilms());
        return {};
    }

    [[nodiscard]] const std::map<std::string, Record>& records() const {
        return mJournal.records();
    }

    [[nodiscard]] const std::map<std::string, std::string>& films() const { return mFilms; }

    [[nodiscard]] core::FrameRate framesPerSecond() const { return mFramesPerSecond; }

  private:
    core::Result<std::unique_ptr<SequenceSource>> openSource() const {
        return SequenceSource::open(mFilm, mFiles, mPlan.frames);
    }

    [[nodiscard]] std::vector<std::string> listKeys() const {
        std::vector<std::string> keys = {std::string(kTruthKey)};
        for (const SamplePoint& point : mPlan.points)
            keys.push_back(makeKey(point));
        return keys;
    }

    [[nodiscard]] std::string filmOf(const std::string& key) const {
        return fmt::format("films/{}.{}.webm", mFilm.name, namePart(key));
    }

    [[nodiscard]] bool hasFilms() const {
        const auto keys = listKeys();
        return !mOptions.encoder || std::all_of(keys.begin(), keys.end(), [&](const auto& key) {
            std::error_code ignored;
            return fs::exists(mOptions.folder / filmOf(key), ignored);
        });
    }

    [[nodiscard]] bool isKnown(SequenceCamera camera, uint32_t frame) const {
        std::vector<std::string> keys = listKeys();
        if (camera == SequenceCamera::Own && mPlan.isSwept(frame))
            for (const SamplePoint& point : mPlan.sweep)
                keys.push_back(makeKey(point));
        return std::all_of(keys.begin(), keys.end(), [&](const std::string& key) {
            return mJournal.find(makeFrameKey(camera, key, frame)).hasPicture;
        });
    }

    [[nodiscard]] bool hasPictures(uint32_t frame) const {
        const auto keys = listKeys();
        return !mOptions.encoder || std::all_of(keys.begin(), keys.end(), [&](const auto& key) {
            std::error_code ignored;
            return fs::exists(fileOfFrame(mFrames, key, frame), ignored);
        });
    }

    /// The first frame that is to be drawn, mPlan.frames where none is.
    [[nodiscard]] uint32_t findStart() const {
        uint32_t start = 0;
        while (start < mPlan.frames && isKnown(SequenceCamera::Own, start))
            ++start;
        if (start == mPlan.frames && hasFilms())
            return start;
        // Pictures of all frames before are needed for the film, and the last one's for flicker.
        uint32_t kept = 0;
        while (kept < start && mOptions.encoder && hasPictures(kept))
            ++kept;
        return std::min(start, kept);
    }

    Status drawOwn() {
        auto source = openSource();
        if (!source)
            return source.error();
        mFramesPerSecond = source.value()->framesPerSecond();
        const uint32_t start = findStart();
        FrameJudge judge;
        if (start > 0 && start < mPlan.frames)
            SHUTTER_TRY(goOnFrom(start - 1, judge));
        if (start < mPlan.frames)
            removeFilms();
        SHUTTER_TRY(makePictureFolders());
        mProgress.advance(countOwnPictures(start));
        for (uint32_t i = 0; i < start; ++i)
            source.value()->advance();
        return drawFrames(*source.value(), SequenceCamera::Own, {start, mPlan.frames}, judge);
    }

    /// Pictures of the frames before this one.
    [[nodiscard]] uint64_t countOwnPictures(uint32_t end) const {
        const auto swept =
            std::count_if(mPlan.sweepFrames.begin(), mPlan.sweepFrames.end(), [&](uint32_t i) {
                return i < end;
            });
        return uint64_t(end) * (mPlan.points.size() + 1) + uint64_t(swept) * mPlan.sweep.size();
    }

    /// Films of an earlier run are outdated.
    void removeFilms() const {
        for (const std::string& key : listKeys()) {
            std::error_code ignored;
            fs::remove(mOptions.folder / filmOf(key), ignored);
        }
    }

    Status drawStanding() {
        bool isDone = true;
        for (uint32_t i = 0; i < mPlan.standingFrames; ++i)
            isDone = isDone && isKnown(SequenceCamera::Standing, i);
        if (isDone) {
            mProgress.advance(mPlan.standingFrames * (mPlan.points.size() + 1));
            return {};
        }
        auto scout = openSource();
        auto source = openSource();
        for (const auto* opened : {&scout, &source})
            if (!*opened)
                return opened->error();
        for (uint32_t i = 0; i <= mPlan.frames / 2; ++i)
            scout.value()->advance();
        for (uint32_t i = 0; i < mPlan.firstStanding; ++i)
            source.value()->advance();
        source.value()->stand(scout.value()->standingView());
        FrameJudge judge;
        return drawFrames(
            *source.value(), SequenceCamera::Standing, {0, mPlan.standingFrames}, judge
        );
    }

    struct FrameRange {
        uint32_t first = 0;
        uint32_t end = 0;
    };

    /// \param source whose next frame is the first of these
    Status drawFrames(
        SequenceSource& source, SequenceCamera camera, const FrameRange& frames, FrameJudge& judge
    ) {
        if (frames.first == frames.end)
            return {};
        const bool keeps = camera == SequenceCamera::Own && mOptions.encoder;
        SequencePass pass(
            mDevice, source, mPlan, mOptions.truth, camera, keeps ? mFrames : fs::path()
        );
        for (uint32_t frame = frames.first; frame < frames.end && !mStop(); ++frame) {
            source.advance();
            mProgress.startPart(fmt::format(
                "{}{}: frame {} of {}",
                mFilm.name,
                camera == SequenceCamera::Standing ? ", camera at rest" : "",
                frame + 1,
                frames.end
            ));
            SHUTTER_TRY(measureFrame(pass, camera, frame, judge));
        }
        return {};
    }

    Status
    measureFrame(SequencePass& pass, SequenceCamera camera, uint32_t frame, FrameJudge& judge) {
        auto drawn = pass.drawFrame(frame, mProgress);
        if (!drawn)
            return drawn.error();
        SHUTTER_TRY(judge.judge(drawn.value()));
        std::map<std::string, Record> records;
        for (FramePicture& picture : drawn.value())
            records[makeFrameKey(camera, picture.key, frame)] = std::move(picture.record);
        return mJournal.setRecords(std::move(records));
    }

    Status goOnFrom(uint32_t frame, FrameJudge& judge) const {
        std::map<std::string, image::Image> shown;
        for (const std::string& key : listKeys()) {
            auto picture = io::readImage(fileOfFrame(mFrames, key, frame));
            if (!picture)
                return picture.error();
            shown[key] = std::move(picture).value();
        }
        judge.goOnFrom(std::string(kTruthKey), std::move(shown));
        return {};
    }

    Status makePictureFolders() const {
        if (!mOptions.encoder)
            return {};
        for (const std::string& key : listKeys()) {
            std::error_code failure;
            const fs::path folder = mFrames / namePart(key);
            fs::create_directories(folder, failure);
            if (failure)
                return core::makeError(
                    "cannot make the folder '{}': {}", folder.string(), failure.message()
                );
        }
        return {};
    }

    /// All films at once; then their frames go.
    Status makeFilms() {
        if (!mOptions.encoder)
            return {};
        const std::vector<std::string> keys = listKeys();
        std::vector<Status> made(keys.size());
        if (!hasFilms())
            core::runParallelJobs(keys.size(), [&](size_t i) {
                const io::VideoFrames frames{
                    mFrames / namePart(keys[i]), kFramePattern, mPlan.frames, mFramesPerSecond};
                made[i] =
                    io::encodeVideo(*mOptions.encoder, frames, mOptions.folder / filmOf(keys[i]));
            });
        for (size_t i = 0; i < keys.size(); ++i) {
            if (!made[i])
                return made[i];
            mFilms[keys[i]] = filmOf(keys[i]);
        }
        std::error_code ignored;
        fs::remove_all(mFrames, ignored);
        return {};
    }

    gpu::Device& mDevice;
    const SequenceCase& mFilm;
    const SequenceFiles& mFiles;
    SequencePlan mPlan;
    const SequenceOptions& mOptions;
    core::Progress& mProgress;
    const StopQuestion& mStop;
    Journal mJournal;
    fs::path mFrames; ///< pictures of the films until those are made
    std::map<std::string, std::string> mFilms;
    core::FrameRate mFramesPerSecond;
};

} // namespace

core::Result<SequenceResult> measureSequence(
    gpu::Device& device,
    const SequenceCase& film,
    const std::vector<const game::MethodInfo*>& methods,
    const SequenceOptions& options,
    core::Progress& progress,
    const StopQuestion& stop
) {
    SequenceResult result;
    const auto files = writeSequenceFiles(film, options.folder);
    if (!files)
        return files.error();
    const auto source = SequenceSource::open(film, files.value(), options.frames);
    if (!source)
        return source.error();
    result.hasLens = source.value()->hasLens();
    std::vector<const game::MethodInfo*> able;
    for (const game::MethodInfo* method : methods)
        if (!game::canRun(*method, device))
            result.skipped.push_back({method, "the device does not trace the rays that it needs"});
        else if (result.hasLens && !method->hasLens && method->family != game::MethodFamily::Sharp)
            result.skipped.push_back(
                {method, "it draws what a pinhole sees, not what the lens does"}
            );
        else
            able.push_back(method);
    const auto hash = computeSequenceHash(film, files.value(), options, device.info());
    if (!hash)
        return hash.error();
    result.plan = planSequence(
        able, options.frames, options.truth.mostInstants, film.shot.picture.antiAliasing
    );
    SequenceRun run(
        device, film, files.value(), result.plan, options, hash.value(), progress, stop
    );
    SHUTTER_TRY(run.run());
    result.framesPerSecond = run.framesPerSecond().perSecond();
    result.records = run.records();
    result.films = run.films();
    return result;
}

} // namespace shutter::bench
