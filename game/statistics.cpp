// SPDX-License-Identifier: MIT
#include "game/statistics.h"

#include "engine/io/file_bytes.h"
#include "engine/scene/shutter.h"
#include "game/quartiles.h"

#include <nlohmann/json.hpp>

#include <algorithm>

namespace shutter::game {

namespace {

nlohmann::json describePicture(const PictureStatistics& picture) {
    const render::FrameStatistics& frame = picture.frame;
    nlohmann::json passes = nlohmann::json::array();
    double gpu = 0.0;
    for (const render::PassTime& pass : frame.passes) {
        passes.push_back(
            {{"name", pass.name},
             {"owner", render::describe(pass.owner)},
             {"gpu_ms", pass.gpuMilliseconds},
             {"cpu_ms", pass.cpuMilliseconds}}
        );
        gpu += pass.gpuMilliseconds;
    }
    nlohmann::json counters = nlohmann::json::object();
    for (const auto& [name, value] : frame.counters)
        counters[name] = value;
    nlohmann::json measures = nlohmann::json::object();
    for (const auto& [name, value] : frame.measures)
        measures[name] = value;
    nlohmann::json decisions = nlohmann::json::object();
    for (const render::Explanation& line : frame.explanations)
        if (line.kind == render::ExplainedKind::Effect)
            decisions[line.subject] = core::describe(line.decision);
    return {
        {"time_s", picture.seconds},
        {"gpu_ms", gpu},
        {"cpu_ms", frame.cpuMilliseconds},
        {"wall_ms", frame.wallMilliseconds},
        {"transient_bytes", frame.transientBytes},
        {"passes", passes},
        {"counters", counters},
        {"measures", measures},
        {"decisions", decisions}};
}

} // namespace

void addStatistics(render::FrameStatistics& total, const render::FrameStatistics& frame) {
    for (const render::PassTime& pass : frame.passes) {
        const auto known = std::find_if(total.passes.begin(), total.passes.end(), [&](auto& p) {
            return p.name == pass.name && p.owner == pass.owner;
        });
        if (known == total.passes.end()) {
            total.passes.push_back(pass);
            continue;
        }
        known->gpuMilliseconds += pass.gpuMilliseconds;
        known->cpuMilliseconds += pass.cpuMilliseconds;
    }
    total.cpuMilliseconds += frame.cpuMilliseconds;
    total.wallMilliseconds += frame.wallMilliseconds;
    for (const auto& [name, value] : frame.counters)
        total.counters[name] += value;
    for (const auto& [name, value] : frame.measures)
        total.measures[name] = value;
    total.explanations = frame.explanations;
    total.transientBytes = std::max(total.transientBytes, frame.transientBytes);
}

render::FrameStatistics computeMedian(const std::vector<render::FrameStatistics>& frames) {
    render::FrameStatistics median = frames.back();
    const auto over = [&](auto pick) {
        std::vector<double> values;
        for (const auto& frame : frames)
            values.push_back(pick(frame));
        return computeQuartiles(std::move(values)).median;
    };
    for (size_t i = 0; i < median.passes.size(); ++i) {
        median.passes[i].gpuMilliseconds =
            over([&](const auto& frame) { return frame.passes.at(i).gpuMilliseconds; });
        median.passes[i].cpuMilliseconds =
            over([&](const auto& frame) { return frame.passes.at(i).cpuMilliseconds; });
    }
    median.cpuMilliseconds = over([](const auto& frame) { return frame.cpuMilliseconds; });
    median.wallMilliseconds = over([](const auto& frame) { return frame.wallMilliseconds; });
    return median;
}

core::Status writeStatistics(
    const std::filesystem::path& path,
    const RenderOptions& options,
    const gpu::DeviceInfo& device,
    const std::vector<PictureStatistics>& pictures
) {
    scene::CameraShutter shutter = options.shutter;
    if (options.flythrough && options.isFlythroughShutter)
        flythrough::applyShutter(*options.flythrough, options.frameTimes.front(), shutter);
    nlohmann::json root = {
        {"scene", options.scene.string()},
        {"method", options.method->name},
        {"samples", options.samples},
        {"width", options.width},
        {"height", options.height},
        {"exposure_s", scene::computeExposureSeconds(shutter, options.frameSeconds)},
        {"device", device.name},
        {"driver", device.driver},
        {"repeat", options.repeat},
        {"pictures", nlohmann::json::array()}};
    for (const PictureStatistics& picture : pictures)
        root["pictures"].push_back(describePicture(picture));
    // A scene's name need not be UTF-8; what is not is replaced.
    const std::string text = root.dump(2, ' ', false, nlohmann::json::error_handler_t::replace);
    if (core::Status written = io::writeFileText(path, text + "\n"); !written)
        return core::makeError("--stats: {}", written.error().message);
    return {};
}

} // namespace shutter::game
