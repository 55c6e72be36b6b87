// SPDX-License-Identifier: MIT
#include "engine/core/log.h"
#include "engine/core/progress.h"
#include "engine/gpu/device.h"
#include "engine/io/image_file.h"
#include "game/cache_folder.h"
#include "game/commands.h"
#include "game/intermediates.h"
#include "game/method_renderer.h"
#include "game/render_options.h"
#include "game/report.h"
#include "game/shot.h"
#include "game/statistics.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <memory>

namespace shutter::game {

namespace {

core::Status
writePicture(const RenderOptions& options, int frameNumber, const render::FrameResult& result) {
    const std::filesystem::path file = frameFile(options.out, frameNumber);
    const image::Image& drawn = options.displayOut ? result.display : result.color;
    const image::Image picture = selectChannels(drawn, {{0, "R"}, {1, "G"}, {2, "B"}});
    if (core::Status written = io::writeImage(file, picture); !written)
        return written;
    for (const std::string& aov : options.aovs) {
        const auto found = result.intermediates.find(aov);
        if (found == result.intermediates.end()) {
            const render::Decision* blur =
                render::findDecision(result.statistics.explanations, "motion blur");
            core::logWarning(
                "--aov {} is not written: {}",
                aov,
                blur ? "motion blur was " + render::describe(*blur)
                     : "one ray a pixel shows no error"
            );
            continue;
        }
        core::Status written = writeIntermediate(intermediateFile(file, aov), aov, found->second);
        if (!written)
            return written;
    }
    return {};
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

core::Status renderAll(const RenderOptions& options, gpu::Device& device) {
    auto shot = loadShot(options);
    if (!shot)
        return shot.error();
    render::Renderer drawing(device, shot.value().world.assets);
    auto created = MethodRenderer::create(device, drawing, shot.value(), options);
    if (!created)
        return created.error();
    MethodRenderer& renderer = *created.value();

    const uint64_t draws = options.repeat > 1 ? options.repeat + 1 : 1;
    core::Progress progress(
        "rendering", options.frameTimes.size() * renderer.stepsPerPicture() * draws
    );
    std::vector<PictureStatistics> pictures;
    for (size_t i = 0; i < options.frameTimes.size(); ++i) {
        auto result = renderRepeated(renderer, options, options.frameTimes[i], progress);
        if (!result)
            return result.error();
        const int number = options.firstFrame + static_cast<int>(i);
        if (i == 0 && options.dumpGraph)
            fmt::print("{}", result.value().dump);
        if (options.explain)
            printExplanations(options.frameTimes[i], result.value().statistics);
        if (core::Status written = writePicture(options, number, result.value()); !written)
            return written;
        pictures.push_back({options.frameTimes[i], result.value().statistics});
    }
    if (options.stats.empty())
        return {};
    return writeStatistics(options.stats, options, device.info(), pictures);
}

int fail(int status, const core::Error& error) {
    printError(error);
    return status;
}

int runRender(const RenderArguments& arguments) {
    auto options = interpret(arguments);
    if (!options)
        return fail(kExitUsage, options.error());
    if (core::Status writable = checkOutputs(options.value()); !writable)
        return fail(kExitFailed, writable.error());
    gpu::DeviceOptions deviceOptions;
    deviceOptions.wanted = options.value().device;
    deviceOptions.validate = options.value().validate;
    deviceOptions.bestTier = options.value().bestTier;
    deviceOptions.cacheFolder = findCacheFolder();
    auto device = gpu::Device::create(deviceOptions);
    if (!device)
        return fail(kExitFailed, device.error());
    if (core::Status done = renderAll(options.value(), *device.value()); !done)
        return fail(kExitFailed, done.error());
    if (const uint32_t messages = device.value()->validationMessageCount(); messages > 0)
        return fail(kExitFailed, core::makeError("{} Vulkan validation messages", messages));
    return kExitDone;
}

} // namespace

void addRenderCommand(CLI::App& app, int& exitStatus) {
    CLI::App* command = app.add_subcommand("render", "render frames without a window");
    auto arguments = std::make_shared<RenderArguments>();
    defineRenderOptions(*command, *arguments);
    command->callback([arguments, &exitStatus] { exitStatus = runRender(*arguments); });
}

} // namespace shutter::game
