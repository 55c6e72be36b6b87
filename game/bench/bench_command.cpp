// SPDX-License-Identifier: MIT
#include "engine/core/log.h"
#include "engine/gpu/device.h"
#include "engine/io/video.h"
#include "game/bench/bench_run.h"
#include "game/bench/contenders.h"
#include "game/bench/report/report_page.h"
#include "game/bench/suites/suite.h"
#include "game/options/program.h"
#include "game/options/render_arguments.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <memory>
#include <optional>
#include <system_error>

namespace shutter::bench {

namespace {

namespace fs = std::filesystem;
using core::Status;
using game::MethodInfo;

struct BenchArguments {
    game::ShotArguments shot;
    gpu::DeviceOptions device;
    std::optional<game::PictureSize> size; ///< nothing: the suite's
    std::string suite;
    fs::path out;
    std::vector<std::string> methods;
    std::vector<std::string> cases;
    std::optional<uint32_t> repeats;
    std::optional<double> limitSeconds;
    std::optional<uint32_t> truthSamples;
    uint32_t frames = 48;
    bool restart = false;
    bool reportOnly = false;
};

constexpr auto kSizeRow = game::makeRow<&BenchArguments::size>(
    "--size", "picture size WxH; default 640x360, for demand 1280x720"
);

std::atomic<bool> sStopped = false;

/// The first Ctrl-C ends the run after the picture being drawn; the second at once.
void stopOnInterrupt(int) {
    sStopped = true;
    std::signal(SIGINT, SIG_DFL);
}

/// Leaves the cases that --case names, all where it names none. Error: the names there are.
template <class T>
Status keepCases(std::vector<T>& cases, const BenchArguments& arguments, std::string_view suite) {
    if (arguments.cases.empty())
        return {};
    std::string names;
    std::vector<T> kept;
    for (const T& one : cases) {
        names += fmt::format("{}{}", names.empty() ? "" : ", ", one.name);
        if (std::count(arguments.cases.begin(), arguments.cases.end(), one.name) > 0)
            kept.push_back(one);
    }
    if (kept.size() != arguments.cases.size())
        return core::makeError(
            "--case {}: the suite {} has {}",
            fmt::join(arguments.cases, ", "),
            suite,
            names.empty() ? "no cases" : names
        );
    cases = std::move(kept);
    return {};
}

/// The colour of a film is of half its size.
Status checkFilmSize(const game::PictureSize& size) {
    if (size.width % 2 == 0 && size.height % 2 == 0)
        return {};
    return core::makeError(
        "--size {}x{}: a film's width and height are even", size.width, size.height
    );
}

/// Sets the size, too, if no option does.
core::Result<Suite> chooseSuite(BenchArguments& arguments) {
    auto suite =
        arguments.suite.empty() ? core::Result<Suite>(Suite()) : findSuite(arguments.suite);
    if (!suite)
        return suite;
    arguments.shot.size = arguments.size.value_or(suite.value().size);
    if (arguments.suite.empty())
        return makeOwnSuite(arguments.shot);
    const auto applySize = [&](Case& shot) {
        shot.shot.size = shot.size.value_or(arguments.shot.size);
    };
    for (Case& shot : suite.value().cases)
        applySize(shot);
    for (ScalingAxis& axis : suite.value().axes)
        for (ScalingPoint& point : axis.points)
            applySize(point.shot);
    Suite& chosen = suite.value();
    for (SequenceCase& film : chosen.sequences)
        film.shot.size = arguments.shot.size;
    if (!chosen.sequences.empty())
        if (const Status even = checkFilmSize(arguments.shot.size); !even)
            return even.error();
    const bool isHeld = !chosen.hardCases.empty() || !chosen.claims.empty();
    Status kept = !chosen.hardCases.empty()   ? keepCases(chosen.hardCases, arguments, chosen.name)
                  : !chosen.claims.empty()    ? keepCases(chosen.claims, arguments, chosen.name)
                  : !chosen.sequences.empty() ? keepCases(chosen.sequences, arguments, chosen.name)
                                              : keepCases(chosen.cases, arguments, chosen.name);
    if (!kept)
        return kept.error();
    if (isHeld && !arguments.methods.empty())
        return core::makeError(
            "--methods has no meaning for the suite {}: its cases choose their own", chosen.name
        );
    return suite;
}

/// All, the truth's own method included: at few instants it is a rival. For films `truth` is left
/// out, whose rays take longer than all others together, and so are the publication's numbers.
core::Result<std::vector<const MethodInfo*>>
chooseMethods(const BenchArguments& arguments, bool areFilms) {
    std::vector<const MethodInfo*> methods;
    if (arguments.methods.empty()) {
        for (const MethodInfo& method : listContenders())
            if (!areFilms ||
                (method.family != game::MethodFamily::Truth && game::findMethod(method.name)))
                methods.push_back(&method);
        return methods;
    }
    for (const std::string& name : arguments.methods) {
        auto method = findContender(name);
        if (!method)
            return core::makeError("--methods: {}", method.error().message);
        methods.push_back(method.value());
    }
    return methods;
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

/// Films that all fit into a page of 20 MB, in base64 beside all else. Without an encoder of such
/// films there are none, and all is measured.
SequenceOptions makeSequenceOptions(const BenchArguments& arguments, const RunOptions& run) {
    constexpr double kFilmBytes = 10.5e6;
    constexpr double kFramesPerSecond = 24.0;
    SequenceOptions options;
    options.frames = arguments.frames;
    options.truth.mostInstants = arguments.truthSamples.value_or(options.truth.mostInstants);
    options.folder = arguments.out;
    const auto films = double(run.suite.sequences.size() * (run.methods.size() + 1));
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

Status measureSuite(
    const BenchArguments& arguments,
    Suite suite,
    std::vector<const MethodInfo*> methods,
    game::ShotOptions shot
) {
    gpu::DeviceOptions deviceOptions = arguments.device;
    deviceOptions.cacheFolder = game::findCacheFolder();
    deviceOptions.keptPipelines = 256; // each case has renderers of its own
    auto device = gpu::Device::create(deviceOptions);
    if (!device)
        return device.error();
    SHUTTER_TRY(makeFolders(arguments));
    std::signal(SIGINT, stopOnInterrupt);
    RunOptions options;
    options.suite = std::move(suite);
    for (Case& one : options.suite.cases)
        one.shot.unlit = one.shot.unlit || arguments.shot.unlit;
    options.methods = std::move(methods);
    options.shot = std::move(shot);
    options.measure.repeats = arguments.repeats.value_or(options.suite.repeats);
    options.measure.limitSeconds = arguments.limitSeconds.value_or(options.suite.limitSeconds);
    options.measure.truthSamples = arguments.truthSamples.value_or(options.measure.truthSamples);
    options.measure.folder = arguments.out;
    options.measure.truthCache = makeTruthCache();
    if (!options.suite.sequences.empty())
        options.sequence = makeSequenceOptions(arguments, options);
    Status done = runSuite(*device.value(), options, [] { return sStopped.load(); });
    if (done && device.value()->validationMessageCount() > 0)
        return core::makeError(
            "{} Vulkan validation messages", device.value()->validationMessageCount()
        );
    return done;
}

int runBench(BenchArguments& arguments) {
    if (arguments.reportOnly) {
        const Status made = remakeReportPage(arguments.out);
        return made ? game::kExitDone : game::fail(game::kExitFailed, made.error());
    }
    if (arguments.shot.scene.empty() == arguments.suite.empty())
        return game::fail(game::kExitUsage, {"bench needs --suite or a SCENE, and not both"});
    auto suite = chooseSuite(arguments);
    if (!suite)
        return game::fail(game::kExitUsage, suite.error());
    auto methods = chooseMethods(arguments, !suite.value().sequences.empty());
    if (!methods)
        return game::fail(game::kExitUsage, methods.error());
    // Wrong options of the shot are told before anything is made.
    auto shot = game::interpret(arguments.shot);
    if (!shot)
        return game::fail(game::kExitUsage, shot.error());
    const Status done = measureSuite(
        arguments, std::move(suite.value()), std::move(methods.value()), std::move(shot.value())
    );
    return done ? game::kExitDone : game::fail(game::kExitFailed, done.error());
}

} // namespace

void addBenchCommand(CLI::App& app, int& exitStatus) {
    CLI::App* command = app.add_subcommand("bench", "what accuracy costs in time");
    auto arguments = std::make_shared<BenchArguments>();
    command->add_option("scene", arguments->shot.scene, "a scene of one's own, instead of --suite");
    command->add_option(
        "--suite", arguments->suite, "suite: paper, hard, scaling, stability, demand or sequence"
    );
    command->add_option("--out", arguments->out, "folder for results.json and index.html")
        ->required();
    command
        ->add_option(
            "--methods", arguments->methods, "methods to measure, comma-separated; default: all"
        )
        ->delimiter(',');
    command->add_option(
        "--case", arguments->cases, "case of the suite to run (repeatable); default: all"
    );
    command
        ->add_option(
            "--repeats",
            arguments->repeats,
            "timed pictures per method and sample count; default: 7"
        )
        ->check(CLI::Range(1u, 1000u));
    command
        ->add_option(
            "--limit",
            arguments->limitSeconds,
            "skip sample counts whose picture takes longer, seconds; default: 60"
        )
        ->check(CLI::PositiveNumber);
    command
        ->add_option(
            "--truth-samples",
            arguments->truthSamples,
            "instants of the truth; default 256, of a sequence's at most 64"
        )
        ->check(CLI::Range(1u, 65536u));
    command->add_option("--frames", arguments->frames, "frames of a sequence; default 48")
        ->check(CLI::Range(2u, 1000u));
    command->add_flag("--restart", arguments->restart, "discard what an earlier run measured");
    command->add_flag(
        "--report-only", arguments->reportOnly, "only make the page from results.json"
    );
    kSizeRow.define(*command, kSizeRow, *arguments);
    game::defineDeviceOptions(*command, arguments->device);
    std::vector<CLI::Option*> shotOptions;
    const std::vector<CLI::Option*> before = command->get_options();
    game::defineShotOptions(*command, arguments->shot);
    for (CLI::Option* option : command->get_options())
        // How a suite's shots are lit is the only thing that is left open.
        if (option->get_name() != "--unlit" &&
            std::find(before.begin(), before.end(), option) == before.end())
            shotOptions.push_back(option->group("Shot (with a SCENE)"));
    command->callback([arguments, shotOptions, &exitStatus] {
        for (const CLI::Option* option : shotOptions)
            if (option->count() > 0 && arguments->shot.scene.empty()) {
                game::printError({fmt::format(
                    "{} needs a SCENE: suites have shots of their own", option->get_name()
                )});
                exitStatus = game::kExitUsage;
                return;
            }
        exitStatus = runBench(*arguments);
    });
}

} // namespace shutter::bench
