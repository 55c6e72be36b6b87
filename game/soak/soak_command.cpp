// SPDX-License-Identifier: MIT
#include "game/soak/soak_command.h"

#include "engine/io/file_bytes.h"
#include "game/bench/report/report_page.h"
#include "game/bench/results.h"
#include "game/demos/demo.h"
#include "game/options/program.h"
#include "game/options/render_arguments.h"
#include "game/soak/soak_run.h"
#include "game/soak/soak_script.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <system_error>
#include <vector>

namespace shutter::soak {

namespace {

constexpr auto kLeastFrames = static_cast<uint32_t>(kMinCycles * kCycleFrames);
constexpr uint32_t kMostFrames = 100'000; ///< a script ends after an hour of its time
constexpr uint32_t kMostStorm = 10'000;

constexpr auto kSizeRow =
    game::makeRow<&SoakOptions::size>("--size", "picture size WxH; default 160x90");

/// results.json of `shutter bench`, whose page shows it.
nlohmann::json
describeResults(const SoakOptions& options, core::Result<SoakResult> result, double seconds) {
    const demand::Claim claim{
        options.demo,
        fmt::format("{}, played twice", options.demo),
        fmt::format(
            "{} frames of the demo {} by a script, with storms of {} things that come and go, and "
            "with methods, views, cameras and sizes that change all the time.",
            options.frames,
            options.demo,
            options.storm
        ),
        nullptr};
    nlohmann::json root = bench::describeOrigin("soak", result.value().device);
    root["complete"] = true;
    root["settings"] = {
        {"width", options.size.width},
        {"height", options.size.height},
        {"repeats", 2},
        {"pixel", "centre"},
        {"tonemap", "Khronos PBR Neutral, sRGB"},
        {"frames", options.frames},
        {"storm", options.storm}};
    for (const char* name : {"metrics", "methods", "cases"})
        root[name] = nlohmann::json::array();
    root["soak"] = {bench::describeClaim({&claim, std::move(result.value().findings), seconds})};
    return root;
}

core::Status soak(const SoakOptions& options) {
    std::error_code failure;
    std::filesystem::create_directories(options.out, failure);
    if (failure)
        return core::makeError(
            "--out: cannot make the folder '{}': {}", options.out.string(), failure.message()
        );
    const auto start = std::chrono::steady_clock::now();
    auto result = runSoak(options);
    if (!result)
        return result.error();
    std::vector<std::string> broken;
    for (const stability::Measured& row : result.value().findings.checks)
        if (!stability::holds(row))
            broken.push_back(row.check);
    const double seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    const nlohmann::json root = describeResults(options, std::move(result), seconds);
    SHUTTER_TRY(io::writeFileText(options.out / "results.json", root.dump(1) + "\n"));
    // A soak is worth its figures even without a page.
    if (bench::checkReportPageCanBeMade())
        SHUTTER_TRY(bench::writeReportPage(root, options.out));
    if (!broken.empty())
        return core::makeError("the soak left its bounds: {}", fmt::join(broken, "; "));
    return {};
}

core::Status check(const SoakOptions& options) {
    const auto demos = game::listDemos();
    const bool isDemo = std::any_of(demos.begin(), demos.end(), [&](const game::DemoInfo& demo) {
        return options.demo == demo.name;
    });
    if (!isDemo)
        return core::makeError("'{}' is not a demo", options.demo);
    return {};
}

int runCommand(const SoakOptions& options) {
    if (const core::Status right = check(options); !right)
        return game::fail(game::kExitUsage, right.error());
    const core::Status done = soak(options);
    return done ? game::kExitDone : game::fail(game::kExitFailed, done.error());
}

} // namespace

void addSoakCommand(CLI::App& app, int& exitStatus) {
    CLI::App* command =
        app.add_subcommand("soak", "thousands of frames of a demo: whether anything grows");
    auto options = std::make_shared<SoakOptions>();
    command->add_option("demo", options->demo, "rally, gallery or spin; default: gallery");
    command->add_option("--out", options->out, "folder for results.json and index.html")
        ->required();
    command
        ->add_option("--frames", options->frames, "frames of each of the two runs; default 20000")
        ->check(CLI::Range(kLeastFrames, kMostFrames));
    command->add_option("--storm", options->storm, "things that come and go at once; default 60")
        ->check(CLI::Range(0u, kMostStorm));
    command->add_option("--assets", options->assets, "folder of the demos' scenes");
    kSizeRow.define(*command, kSizeRow, *options);
    game::defineDeviceOptions(*command, options->device);
    command->callback([options, &exitStatus] { exitStatus = runCommand(*options); });
}

} // namespace shutter::soak
