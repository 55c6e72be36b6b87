// SPDX-License-Identifier: MIT
#include "engine/core/log.h"
#include "engine/core/words.h"
#include "engine/gpu/device.h"
#include "engine/io/video.h"
#include "game/bench/bench_arguments.h"
#include "game/bench/bench_run.h"
#include "game/bench/report/report_page.h"
#include "game/options/program.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <memory>
#include <string>
#include <system_error>

namespace shutter::bench {

namespace {

namespace fs = std::filesystem;
using core::Status;

std::atomic<bool> sStopped = false;

/// The first Ctrl-C ends the run after the picture being drawn; the second at once.
void stopOnInterrupt(int) {
    sStopped = true;
    std::signal(SIGINT, SIG_DFL);
}

Status makeFolders(const BenchArguments& arguments) {
    std::error_code failure;
    if (arguments.restart)
        fs::remove_all(arguments.out / "journal", failure);
    for (const char* part : {"images", "journal", "scenes", "films"}) {
        fs::create_directories(arguments.out / part, failure);
        if (failure)
            return core::makeError(
                "--out: cannot make the folder '{}': {}",
                (arguments.out / part).string(),
                failure.message()
            );
    }
    return {};
}

/// Empty where no cache can be kept, which is slower and not wrong.
fs::path makeTruthCache() {
    const fs::path cache = game::findCacheFolder();
    if (cache.empty())
        return {};
    std::error_code failure;
    fs::create_directories(cache / "truth", failure);
    return failure ? fs::path() : cache / "truth";
}

/// Films that take 10.5 MB together, which the page holds in base64. Without an encoder of such
/// films there are none, and all is measured.
SequenceOptions makeSequenceOptions(const BenchArguments& arguments, const BenchTask& task) {
    constexpr double kFilmBytes = 10.5e6;
    constexpr double kFramesPerSecond = 24.0;
    SequenceOptions options;
    options.frames = arguments.frames;
    options.truth.mostInstants = arguments.truthSamples.value_or(options.truth.mostInstants);
    options.folder = arguments.out;
    const auto films = double(task.suite.sequences.size() * (task.methods.size() + 1));
    const double seconds = std::max(options.frames / kFramesPerSecond, 1.0);
    const auto kilobits = uint32_t(kFilmBytes * 8.0 / 1000.0 / (films * seconds));
    auto encoder =
        io::findVideoEncoder({}, {io::VideoCodec::Vp9, 8, "", std::clamp(kilobits, 50u, 4000u)});
    if (encoder)
        options.encoder = std::move(encoder).value();
    else
        core::logWarning("the report has no films: {}", encoder.error().message);
    return options;
}

Status measureTask(const BenchArguments& arguments, BenchTask task) {
    gpu::DeviceOptions deviceOptions = arguments.device;
    deviceOptions.cacheFolder = game::findCacheFolder();
    deviceOptions.keptPipelines = 256; // each case makes its own renderers
    auto device = gpu::Device::create(deviceOptions);
    if (!device)
        return device.error();
    SHUTTER_TRY(makeFolders(arguments));
    RunOptions options;
    options.given = arguments.given;
    std::signal(SIGINT, stopOnInterrupt);
    if (!task.suite.sequences.empty())
        options.sequence = makeSequenceOptions(arguments, task);
    options.suite = std::move(task.suite);
    for (Case& one : options.suite.cases)
        one.shot.unlit = one.shot.unlit || arguments.shot.unlit;
    options.methods = std::move(task.methods);
    options.shot = std::move(task.shot);
    options.measure.repeats = arguments.repeats.value_or(options.suite.repeats);
    options.measure.limitSeconds = arguments.limitSeconds.value_or(options.suite.limitSeconds);
    options.measure.truthSamples = arguments.truthSamples.value_or(options.measure.truthSamples);
    options.measure.folder = arguments.out;
    options.measure.truthCache = makeTruthCache();
    Status done = runSuite(*device.value(), options, [] { return sStopped.load(); });
    if (done && device.value()->validationMessageCount() > 0)
        return core::Error{
            core::countOf(device.value()->validationMessageCount(), "Vulkan validation message")};
    return done;
}

int runBench(const BenchArguments& arguments) {
    if (arguments.reportOnly) {
        const Status made = remakeReportPage(arguments.out);
        return made ? game::kExitDone : game::fail(game::kExitFailed, made.error());
    }
    // Report wrong options of the shot before creating anything.
    auto task = interpretBench(arguments);
    if (!task)
        return game::fail(game::kExitUsage, task.error());
    // Hours of measuring are worth their figures even without a page.
    if (const Status page = checkReportPageCanBeMade(); !page)
        core::logWarning("{}; results.json is written alone", page.error().message);
    const Status done = measureTask(arguments, std::move(task).value());
    return done ? game::kExitDone : game::fail(game::kExitFailed, done.error());
}

} // namespace

void defineBench(CLI::App& app, int& exitStatus) {
    auto arguments = std::make_shared<BenchArguments>();
    defineBenchOptions(app, *arguments);
    app.callback([&app, arguments, &exitStatus] {
        arguments->given = listGivenOptions(app);
        exitStatus = runBench(*arguments);
    });
}

} // namespace shutter::bench
