// SPDX-License-Identifier: MIT
#include "game/bench/bench_arguments.h"

#include "game/bench/contenders.h"
#include "game/options/option_rows.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <string_view>
#include <utility>

namespace shutter::bench {

namespace {

using core::Status;
using game::MethodInfo;

constexpr auto kSizeRow =
    game::makeRow<&game::ShotArguments::size>("--size", "picture size WxH; default 640x360");

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

/// Sets the pixel model of the truth, and the anti-aliasing of methods.
Status applyEdges(const BenchArguments& arguments, Suite& suite) {
    const bool hasPixel = arguments.pixelOption != nullptr && arguments.pixelOption->count() > 0;
    if (!suite.axes.empty() && (hasPixel || !arguments.antiAliasings.empty()))
        return core::makeError(
            "{}: the suite {} measures times alone", hasPixel ? "--pixel" : "--aa", suite.name
        );
    if (hasPixel)
        suite.pixel = arguments.shot.pixel;
    if (!arguments.antiAliasings.empty())
        suite.antiAliasings.clear();
    for (const std::string& word : arguments.antiAliasings) {
        game::PictureSettings picture;
        const auto& row = core::getRow(game::listPictureRows(), "antiAliasing");
        if (const Status parsed = core::parseValue(row, word, picture); !parsed)
            return core::makeError("--aa: {}", parsed.error().message);
        if (std::count(
                suite.antiAliasings.begin(), suite.antiAliasings.end(), picture.antiAliasing
            ) > 0)
            return core::makeError("--aa: {} is there twice", word);
        suite.antiAliasings.push_back(picture.antiAliasing);
    }
    spreadAntiAliasing(suite);
    return {};
}

core::Result<Suite> chooseSuite(const BenchArguments& arguments) {
    auto suite =
        arguments.suite.empty() ? core::Result<Suite>(Suite()) : findSuite(arguments.suite);
    if (!suite)
        return suite;
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
    Status kept = chosen.sequences.empty() ? keepCases(chosen.cases, arguments, chosen.name)
                                           : keepCases(chosen.sequences, arguments, chosen.name);
    if (!kept)
        return kept.error();
    if (const Status provided = provideRooms(chosen, arguments.rooms); !provided)
        return provided.error();
    return suite;
}

/// Whether the suite measures the method by default, without --methods.
bool isWanted(const MethodInfo& method, const Suite& suite) {
    // Their rays take longer than all others together.
    const bool isFilm = !suite.sequences.empty();
    if (isFilm && (method.family == game::MethodFamily::Truth || !game::findMethod(method.name)))
        return false;
    if (suite.hasLens)
        return method.hasLens || method.family == game::MethodFamily::Sharp;
    return method.lensFilter == nullptr && !isOnDialAlone(method.name);
}

/// All, the truth's own method included: at few instants it is a rival. For films `truth` is left
/// out and so are the publication's numbers; with a lens, what draws a pinhole, and without one
/// what filters by it.
core::Result<std::vector<const MethodInfo*>>
chooseMethods(const BenchArguments& arguments, const Suite& suite) {
    std::vector<const MethodInfo*> methods;
    std::vector<std::string> names = arguments.methods;
    if (names.empty())
        names.assign(suite.dial.begin(), suite.dial.end());
    if (names.empty()) {
        for (const MethodInfo& method : listContenders())
            if (isWanted(method, suite))
                methods.push_back(&method);
        return methods;
    }
    for (const std::string& name : names) {
        auto method = findContender(name);
        if (!method)
            return core::makeError("--methods: {}", method.error().message);
        methods.push_back(method.value());
    }
    return methods;
}

} // namespace

std::vector<std::string> listGivenOptions(const CLI::App& command) {
    constexpr std::string_view kWithoutEffect[] = {
        "--out", "--rooms", "--restart", "--report-only"};
    std::vector<std::string> given;
    for (const CLI::Option* option : command.get_options()) {
        const std::string name = option->get_name();
        if (option->count() == 0 ||
            std::find(std::begin(kWithoutEffect), std::end(kWithoutEffect), name) !=
                std::end(kWithoutEffect))
            continue;
        const std::vector<std::string>& values = option->results();
        const char delimiter = option->get_delimiter();
        if (option->get_positional())
            given.push_back(std::filesystem::path(values.front()).filename().string());
        else if (option->get_items_expected_max() == 0)
            given.push_back(name);
        else if (delimiter != '\0')
            given.push_back(fmt::format("{} {}", name, fmt::join(values, std::string(1, delimiter)))
            );
        else
            for (const std::string& value : values)
                given.push_back(fmt::format("{} {}", name, value));
    }
    return given;
}

core::Result<BenchTask> interpretBench(const BenchArguments& arguments) {
    for (const CLI::Option* option : arguments.shotOptions)
        if (option->count() > 0 && arguments.shot.scene.empty())
            return core::makeError(
                "{} needs a SCENE: suites have shots of their own", option->get_name()
            );
    if (arguments.shot.scene.empty() == arguments.suite.empty())
        return core::makeError("bench needs --suite or a SCENE, and not both");
    auto suite = chooseSuite(arguments);
    if (!suite)
        return suite.error();
    SHUTTER_TRY(applyEdges(arguments, suite.value()));
    auto methods = chooseMethods(arguments, suite.value());
    if (!methods)
        return methods.error();
    auto shot = game::interpret(arguments.shot);
    if (!shot)
        return shot.error();
    return BenchTask{std::move(suite.value()), std::move(methods.value()), std::move(shot.value())};
}

void defineBenchOptions(CLI::App& command, BenchArguments& arguments) {
    command.add_option("scene", arguments.shot.scene, "a scene of one's own, instead of --suite");
    command.add_option(
        "--suite",
        arguments.suite,
        "suite: paper, hard, scaling, sequence, edges, lens, look or dial"
    );
    command.add_option("--rooms", arguments.rooms, "folder of the rooms of the suite lens")
        ->capture_default_str();
    command.add_option("--out", arguments.out, "folder for results.json and index.html")
        ->required();
    command
        .add_option(
            "--methods", arguments.methods, "methods to measure, comma-separated; default: all"
        )
        ->delimiter(',');
    command.add_option(
        "--case", arguments.cases, "case of the suite to run (repeatable); default: all"
    );
    command
        .add_option(
            "--repeats", arguments.repeats, "timed pictures per method and sample count; default: 7"
        )
        ->check(CLI::Range(1u, 1000u));
    command
        .add_option(
            "--limit",
            arguments.limitSeconds,
            "skip sample counts, except defaults, whose picture takes longer, seconds; default: 30 "
            "to 120, by suite"
        )
        ->check(
            [](const std::string& text) {
                const auto number = core::parseNumber(text);
                return number && *number > 0.0 ? "" : text + " must be above 0";
            },
            "POSITIVE"
        );
    command
        .add_option(
            "--truth-samples",
            arguments.truthSamples,
            "instants of the truth; default 256, of a sequence's at most 64"
        )
        ->check(CLI::Range(1u, 65536u));
    command.add_option("--frames", arguments.frames, "frames of a sequence; default 48")
        ->check(CLI::Range(2u, 1000u));
    command.add_flag("--restart", arguments.restart, "discard what an earlier run measured");
    command.add_flag("--report-only", arguments.reportOnly, "only make the page from results.json");
    kSizeRow.define(command, kSizeRow, arguments.shot);
    game::defineDeviceOptions(command, arguments.device);
    const std::vector<CLI::Option*> before = command.get_options();
    game::defineSceneOptions(command, arguments.shot);
    game::defineShotOptions(command, arguments.shot);
    arguments.pixelOption = command.get_option("--pixel");
    // Its pictures are those of the methods alone; --aa takes several words here.
    for (const char* name : {"--aa", "--bloom", "--bloom-threshold", "--bloom-knee"})
        command.remove_option(command.get_option(name));
    for (CLI::Option* option : command.get_options())
        // How a suite's shots are lit and the pixel filter are the only things left open.
        if (option->get_name() != "--unlit" && option->get_name() != "--pixel" &&
            std::find(before.begin(), before.end(), option) == before.end())
            arguments.shotOptions.push_back(option->group("Shot (with a SCENE)"));
    command
        .add_option(
            "--aa",
            arguments.antiAliasings,
            "how methods smooth edges, comma-separated: none, taa, box; each case is measured with "
            "each; default: none, of the suites edges and lens all three"
        )
        ->delimiter(',');
}

} // namespace shutter::bench
