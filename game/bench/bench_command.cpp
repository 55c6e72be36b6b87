// SPDX-License-Identifier: MIT
#include "engine/core/log.h"
#include "engine/gpu/device.h"
#include "engine/io/video.h"
#include "game/bench/bench_parts.h"
#include "game/bench/bench_run.h"
#include "game/bench/contenders.h"
#include "game/bench/report/report_page.h"
#include "game/bench/suites/suite.h"
#include "game/options/program.h"
#include "game/options/render_arguments.h"
#include "game/parts/job_options.h"
#include "game/parts/part_device.h"
#include "game/parts/part_processes.h"
#include "game/parts/part_slurm.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <csignal>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
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
    parts::JobOptions jobs;

    std::vector<CLI::Option*> shotOptions;        ///< which only a scene of one's own has
    std::vector<const CLI::Option*> benchOptions; ///< all but those of `jobs`
};

/// What is to be measured.
struct BenchTask {
    Suite suite;
    size_t sequenceCount = 0; ///< of the whole suite, of which a part has one
    std::vector<const MethodInfo*> methods;
    game::ShotOptions shot;
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
SequenceOptions makeSequenceOptions(const BenchArguments& arguments, const BenchTask& task) {
    constexpr double kFilmBytes = 10.5e6;
    constexpr double kFramesPerSecond = 24.0;
    SequenceOptions options;
    options.frames = arguments.frames;
    options.truth.mostInstants = arguments.truthSamples.value_or(options.truth.mostInstants);
    options.folder = arguments.out;
    const auto films = double(task.sequenceCount * (task.methods.size() + 1));
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

/// Error: names the option.
core::Result<BenchTask> interpretBench(BenchArguments& arguments) {
    for (const CLI::Option* option : arguments.shotOptions)
        if (option->count() > 0 && arguments.shot.scene.empty())
            return core::makeError(
                "{} needs a SCENE: suites have shots of their own", option->get_name()
            );
    if (arguments.shot.scene.empty() == arguments.suite.empty())
        return core::makeError("bench needs --suite or a SCENE, and not both");
    SHUTTER_TRY(parts::checkJobs(arguments.jobs));
    auto suite = chooseSuite(arguments);
    if (!suite)
        return suite.error();
    auto methods = chooseMethods(arguments, !suite.value().sequences.empty());
    if (!methods)
        return methods.error();
    auto shot = game::interpret(arguments.shot);
    if (!shot)
        return shot.error();
    const size_t sequenceCount = suite.value().sequences.size();
    return BenchTask{
        std::move(suite.value()),
        sequenceCount,
        std::move(methods.value()),
        std::move(shot.value())};
}

/// \param workFolder of a run in parts; empty: it is none
/// \param part of the run, where it is one
Status measureTask(
    const BenchArguments& arguments,
    BenchTask task,
    const fs::path& workFolder = {},
    uint32_t part = 0
) {
    gpu::DeviceOptions deviceOptions = arguments.device;
    deviceOptions.cacheFolder = game::findCacheFolder();
    deviceOptions.keptPipelines = 256; // each case has renderers of its own
    auto device = gpu::Device::create(deviceOptions);
    if (!device)
        return device.error();
    const gpu::DeviceInfo& info = device.value()->info();
    RunOptions options;
    if (!workFolder.empty()) {
        SHUTTER_TRY(
            parts::settleDevice(parts::deviceFile(workFolder), {info.name, info.driver}, kBenchNoun)
        );
        options.partFile = partResults(workFolder, part);
    }
    SHUTTER_TRY(makeFolders(arguments));
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
        return core::makeError(
            "{} Vulkan validation messages", device.value()->validationMessageCount()
        );
    return done;
}

Status measureInParts(const BenchArguments& arguments, const Suite& suite) {
    constexpr std::array<std::string_view, 1> kLeft = {"--restart"};
    auto plan = makeBenchPlan(
        parts::listTypedWords(arguments.benchOptions, kLeft), listBenchParts(suite), arguments.jobs
    );
    if (!plan)
        return plan.error();
    SHUTTER_TRY(makeFolders(arguments));
    const fs::path folder = findBenchFolder(arguments.out);
    SHUTTER_TRY(keepBenchPlan(plan.value(), folder, arguments.restart));
    const parts::PartWork work = describeBenchWork(plan.value(), folder);
    if (arguments.jobs.slurm)
        return parts::runBySlurm(work, arguments.jobs);
    SHUTTER_TRY(parts::runHere(work, arguments.jobs));
    return finishBench(plan.value(), folder);
}

int runBench(BenchArguments& arguments) {
    if (arguments.reportOnly) {
        const Status made = remakeReportPage(arguments.out);
        return made ? game::kExitDone : game::fail(game::kExitFailed, made.error());
    }
    // Wrong options of the shot are told before anything is made.
    auto task = interpretBench(arguments);
    if (!task)
        return game::fail(game::kExitUsage, task.error());
    const parts::JobOptions& jobs = arguments.jobs;
    const bool isInParts = jobs.jobs > 1 || jobs.slurm || !jobs.devices.empty();
    const Status done = isInParts ? measureInParts(arguments, task.value().suite)
                                  : measureTask(arguments, std::move(task.value()));
    return done ? game::kExitDone : game::fail(game::kExitFailed, done.error());
}

void defineBenchOptions(CLI::App* command, const std::shared_ptr<BenchArguments>& arguments) {
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
    const std::vector<CLI::Option*> before = command->get_options();
    game::defineShotOptions(*command, arguments->shot);
    for (CLI::Option* option : command->get_options())
        // How a suite's shots are lit is the only thing that is left open.
        if (option->get_name() != "--unlit" &&
            std::find(before.begin(), before.end(), option) == before.end())
            arguments->shotOptions.push_back(option->group("Shot (with a SCENE)"));
    for (const CLI::Option* option : command->get_options())
        if (option->get_name() != "--help")
            arguments->benchOptions.push_back(option);
    parts::defineJobOptions(*command, arguments->jobs);
}

struct PartArguments {
    fs::path folder;
    uint32_t part = 0;
    std::string device;
};

Status measurePart(const PartArguments& part) {
    const fs::path folder = fs::absolute(part.folder).lexically_normal();
    const auto plan = openBenchPlan(folder);
    if (!plan)
        return plan.error();
    if (part.part >= plan.value().parts.size())
        return core::makeError(
            "part {} is none of the benchmark's: it has parts 0 to {}",
            part.part,
            plan.value().parts.size() - 1
        );
    CLI::App app;
    const auto arguments = std::make_shared<BenchArguments>();
    defineBenchOptions(&app, arguments);
    std::vector<std::string> reversed(plan.value().words.rbegin(), plan.value().words.rend());
    try {
        app.parse(std::move(reversed)); // in the order that CLI11 takes
    } catch (const CLI::ParseError& error) {
        return core::makeError("{}: {}", benchPlanFile(folder).string(), error.what());
    }
    auto task = interpretBench(*arguments);
    if (!task)
        return task.error();
    if (!part.device.empty())
        arguments->device.wanted = part.device;
    task.value().suite = keepBenchPart(std::move(task.value().suite), part.part);
    return measureTask(*arguments, std::move(task.value()), folder, part.part);
}

Status finishPlanned(const PartArguments& part) {
    const fs::path folder = fs::absolute(part.folder).lexically_normal();
    const auto plan = openBenchPlan(folder);
    return plan ? finishBench(plan.value(), folder) : Status(plan.error());
}

/// A command that `--help` does not list: the processes of a run in parts run it.
CLI::App* addHiddenCommand(
    CLI::App& app,
    const char* name,
    const char* help,
    int& exitStatus,
    const std::shared_ptr<PartArguments>& arguments,
    Status (*run)(const PartArguments&)
) {
    CLI::App* command = app.add_subcommand(name, help);
    command->group("");
    command->add_option("folder", arguments->folder, "working folder of the benchmark")->required();
    command->callback([arguments, run, &exitStatus] {
        const Status done = run(*arguments);
        exitStatus = done ? game::kExitDone : game::fail(game::kExitFailed, done.error());
    });
    return command;
}

} // namespace

void addBenchCommand(CLI::App& app, int& exitStatus) {
    CLI::App* command = app.add_subcommand("bench", "what accuracy costs in time");
    auto arguments = std::make_shared<BenchArguments>();
    defineBenchOptions(command, arguments);
    command->callback([arguments, &exitStatus] { exitStatus = runBench(*arguments); });

    auto part = std::make_shared<PartArguments>();
    CLI::App* measure = addHiddenCommand(
        app,
        kBenchPartCommand,
        "measure a part of a planned benchmark",
        exitStatus,
        part,
        measurePart
    );
    measure->add_option("part", part->part, "index of the part")->required();
    measure->add_option("--device", part->device, "in place of the benchmark's --device");
    addHiddenCommand(
        app,
        kBenchFinishCommand,
        "merge the parts of a benchmark",
        exitStatus,
        std::make_shared<PartArguments>(),
        finishPlanned
    );
}

} // namespace shutter::bench
