// SPDX-License-Identifier: MIT
#include "game/statistics.h"

#include "engine/json/json_file.h"
#include "engine/scene/shutter.h"
#include "game/quartiles.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

namespace shutter::game {

namespace {

using nlohmann::ordered_json;

/// Null for a figure that is not finite, which JSON cannot hold.
ordered_json describeNumber(double number) {
    return std::isfinite(number) ? ordered_json(number) : ordered_json();
}

ordered_json describePass(const render::PassTime& pass) {
    ordered_json described;
    described["cpu_ms"] = describeNumber(pass.cpuMilliseconds);
    described["gpu_ms"] = describeNumber(pass.gpuMilliseconds);
    described["name"] = pass.name;
    described["owner"] = render::describe(pass.owner);
    return described;
}

/// Fields in alphabetical order.
ordered_json describePicture(const PictureStatistics& picture) {
    const render::FrameStatistics& frame = picture.frame;
    double gpu = 0.0;
    ordered_json passes = ordered_json::array();
    for (const render::PassTime& pass : frame.passes) {
        passes.push_back(describePass(pass));
        gpu += pass.gpuMilliseconds;
    }
    std::map<std::string, std::string> decisions;
    for (const render::Explanation& line : frame.explanations)
        if (line.kind == render::ExplainedKind::Effect)
            decisions[line.subject] = core::describe(line.decision);
    ordered_json measures = ordered_json::object();
    for (const auto& [name, value] : frame.measures)
        measures[name] = describeNumber(value);
    ordered_json described;
    described["counters"] = frame.counters;
    described["cpu_ms"] = describeNumber(frame.cpuMilliseconds);
    described["decisions"] = decisions;
    described["gpu_ms"] = describeNumber(gpu);
    described["measures"] = measures;
    described["passes"] = passes;
    described["time_s"] = describeNumber(picture.seconds);
    described["transient_bytes"] = frame.transientBytes;
    described["wall_ms"] = describeNumber(frame.wallMilliseconds);
    return described;
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
    ordered_json root;
    root["device"] = device.name;
    root["driver"] = device.driver;
    root["exposure_s"] =
        describeNumber(scene::computeExposureSeconds(shutter, options.frameSeconds));
    root["height"] = options.height;
    root["method"] = options.method->name;
    ordered_json& described = root["pictures"] = ordered_json::array();
    for (const PictureStatistics& picture : pictures)
        described.push_back(describePicture(picture));
    root["repeat"] = options.repeat;
    root["samples"] = options.samples;
    root["scene"] = options.scene.string();
    root["width"] = options.width;
    if (core::Status written = json::writeJsonFile(path, root); !written)
        return core::makeError("--stats: {}", written.error().message);
    return {};
}

} // namespace shutter::game
