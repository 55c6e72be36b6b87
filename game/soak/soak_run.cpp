// SPDX-License-Identifier: MIT
#include "game/soak/soak_run.h"

#include "engine/core/process_use.h"
#include "engine/core/progress.h"
#include "engine/io/file_bytes.h"
#include "engine/json/json_file.h"
#include "game/play/loop/play_loop.h"
#include "game/soak/soak_script.h"
#include "game/soak/storm_stage.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <chrono>
#include <optional>
#include <system_error>
#include <utility>

namespace shutter::soak {

namespace {

namespace fs = std::filesystem;
using stability::Measured;
using Clock = std::chrono::steady_clock;

constexpr uint32_t kRuns = 2;

/// Takes the samples of one run.
class SoakWatch : public game::SessionWatch {
  public:
    SoakWatch(const SoakOptions& options, uint32_t run, core::Progress& progress)
        : mOptions(options), mRun(run), mProgress(progress) {}

    [[nodiscard]] std::unique_ptr<game::Stage> wrap(std::unique_ptr<game::Stage> stage) override {
        auto storm = game::makeStormStage(std::move(stage), mOptions.storm);
        mStage = storm.get();
        return storm;
    }

    void notePicture(uint32_t picture, gpu::Device& device, const std::function<void()>& finish)
        override {
        if (mOptions.disturb)
            mOptions.disturb({mRun, picture, device, *mStage});
        noteTimes();
        mProgress.advance();
        if ((picture + 1) % kCycleFrames != 0)
            return;
        finish();
        device.collectIdle();
        mDevice = device.info();
        mSamples.push_back(
            {picture + 1,
             core::findResidentBytes(),
             device.living(),
             math::computeQuartiles(std::exchange(mWall, {})),
             math::computeQuartiles(std::exchange(mProcessor, {}))}
        );
        // What measuring took is no frame's.
        mLastWall = Clock::now();
        mLastProcessor = core::countProcessorMilliseconds();
    }

    [[nodiscard]] const RunSamples& samples() const { return mSamples; }

    [[nodiscard]] const gpu::DeviceInfo& device() const { return mDevice; }

  private:
    void noteTimes() {
        const Clock::time_point wall = Clock::now();
        const double processor = core::countProcessorMilliseconds();
        mWall.push_back(std::chrono::duration<double, std::milli>(wall - mLastWall).count());
        mProcessor.push_back(processor - mLastProcessor);
        mLastWall = wall;
        mLastProcessor = processor;
    }

    const SoakOptions& mOptions;
    uint32_t mRun;
    core::Progress& mProgress;
    game::Stage* mStage = nullptr;
    Clock::time_point mLastWall = Clock::now();
    double mLastProcessor = core::countProcessorMilliseconds();
    std::vector<double> mWall;      ///< milliseconds of the cycle's frames
    std::vector<double> mProcessor; ///< the same
    RunSamples mSamples;
    gpu::DeviceInfo mDevice;
};

/// Paths of one run.
struct RunFiles {
    fs::path pictures;
    fs::path script;
    fs::path settings;
};

core::Result<RunFiles> writeFiles(const SoakOptions& options, uint32_t run) {
    RunFiles files{
        options.out / fmt::format("pictures_{}", run + 1),
        options.out / fmt::format("script_{}.json", run + 1),
        options.out / "settings.json"};
    std::error_code failure;
    fs::remove_all(files.pictures, failure); // an earlier soak's
    fs::create_directories(files.pictures, failure);
    if (failure)
        return core::makeError(
            "cannot make the folder '{}': {}", files.pictures.string(), failure.message()
        );
    SHUTTER_TRY(json::writeJsonFile(
        files.script, makeSoakScript(options.frames, options.size, files.pictures)
    ));
    SHUTTER_TRY(json::writeJsonFile(files.settings, makeSoakSettings()));
    return files;
}

/// Plays one run to its end.
core::Status play(const SoakOptions& options, const RunFiles& files, SoakWatch& watch) {
    game::PlayArguments arguments;
    arguments.shot.scene = options.demo;
    arguments.shot.size = options.size;
    arguments.shot.allowOutside = true; // the script is ours
    arguments.script = files.script.string();
    arguments.settings = files.settings.string();
    arguments.assets = options.assets.string();
    arguments.noWindow = true;
    auto session = game::interpret(arguments);
    if (!session)
        return session.error();
    session.value().device = options.device;
    auto loop = game::PlayLoop::open(session.value(), &watch);
    if (!loop)
        return loop.error();
    return loop.value()->run();
}

/// The pictures of the chosen frames in both runs.
core::Result<Measured> comparePictures(const SoakOptions& options, const RunFiles files[kRuns]) {
    Measured row{"pictures of chosen frames that differ between the runs", 0.0, 0.0, ""};
    for (const uint32_t frame : chooseFrames(options.frames)) {
        const auto first = io::computeFileHash(pictureFile(files[0].pictures, frame));
        if (!first)
            return first.error();
        const auto second = io::computeFileHash(pictureFile(files[1].pictures, frame));
        if (!second)
            return second.error();
        ++row.samples;
        if (first.value() == second.value())
            continue;
        if (row.worst == 0.0)
            row.note = fmt::format("first: frame {}", frame);
        row.worst += 1.0;
    }
    return row;
}

} // namespace

core::Result<SoakResult> runSoak(const SoakOptions& options) {
    SoakResult result;
    RunFiles files[kRuns];
    std::vector<RunSamples> runs;
    core::Progress progress("soaking", uint64_t{kRuns} * options.frames);
    for (uint32_t run = 0; run < kRuns; ++run) {
        auto written = writeFiles(options, run);
        if (!written)
            return written.error();
        files[run] = std::move(written).value();
        SoakWatch watch(options, run, progress);
        SHUTTER_TRY(play(options, files[run], watch));
        runs.push_back(watch.samples());
        result.device = watch.device();
    }
    auto pictures = comparePictures(options, files);
    if (!pictures)
        return pictures.error();
    stability::Measurements& checks = result.findings.checks;
    checks.push_back(std::move(pictures).value());
    for (uint32_t run = 0; run < kRuns; ++run)
        for (Measured& row :
             judgeRun(fmt::format("run {}", run + 1), runs[run], result.device.kind == "software"))
            checks.push_back(std::move(row));
    result.findings.curves = drawCurves(runs);
    return result;
}

} // namespace shutter::soak
