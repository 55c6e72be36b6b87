// SPDX-License-Identifier: MIT
#include "game/output/extra_files.h"

#include "engine/io/file_bytes.h"
#include "engine/io/image_file.h"
#include "engine/json/json_file.h"
#include "engine/scene/shutter.h"
#include "game/shot/shot.h"

#include <nlohmann/json.hpp>

#include <cmath>
#include <map>
#include <string>
#include <vector>

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

image::Image selectChannels(const image::Image& image, std::span<const Channel> channels) {
    image::Image chosen(image.width, image.height, static_cast<uint32_t>(channels.size()));
    for (const Channel& channel : channels)
        chosen.channelNames.push_back(channel.name);
    for (uint32_t y = 0; y < image.height; ++y)
        for (uint32_t x = 0; x < image.width; ++x)
            for (uint32_t c = 0; c < chosen.channels; ++c)
                chosen.at(x, y, c) = image.at(x, y, channels[c].source);
    return chosen;
}

std::filesystem::path intermediateFile(const std::filesystem::path& out, const std::string& aov) {
    std::filesystem::path file = out;
    return file.replace_extension(aov + ".exr");
}

core::Status writeIntermediate(
    const std::filesystem::path& path,
    const std::string& aov,
    const image::Image& image,
    const std::optional<io::FrameStamp>& stamp
) {
    const image::Image chosen = selectChannels(image, debug_view::findView(aov)->channels);
    return stamp ? io::writeStampedImage(path, chosen, *stamp) : io::writeImage(path, chosen);
}

core::Status writeStatistics(
    const std::filesystem::path& path,
    const RenderOptions& options,
    const gpu::DeviceInfo& device,
    const std::vector<PictureStatistics>& pictures
) {
    const std::vector<double>& times = options.shot.frameTimes;
    const scene::ExposureInterval exposure =
        computeExposure(options.shot, options.shot.shutter, times.empty() ? 0.0 : times.front());
    ordered_json root;
    root["device"] = device.name;
    root["driver"] = device.driver;
    root["exposure_s"] = describeNumber(exposure.close - exposure.open);
    root["height"] = options.shot.height;
    root["method"] = options.method.method->name;
    ordered_json& described = root["pictures"] = ordered_json::array();
    for (const PictureStatistics& picture : pictures)
        described.push_back(describePicture(picture));
    root["repeat"] = options.output.repeat;
    root["samples"] = options.method.samples;
    root["scene"] = options.shot.scene.string();
    root["width"] = options.shot.width;
    if (core::Status written = json::writeJsonFile(path, root); !written)
        return core::makeError("--stats: {}", written.error().message);
    return {};
}

core::Status writePassHashes(
    const std::filesystem::path& path,
    const gpu::DeviceInfo& device,
    const std::vector<render::WrittenImage>& written
) {
    ordered_json root;
    root["device"] = device.name;
    root["driver"] = device.driver;
    ordered_json& rows = root["images"] = ordered_json::array();
    for (const render::WrittenImage& image : written) {
        ordered_json& row = rows.emplace_back();
        row["frame"] = image.frame;
        row["pass"] = image.pass;
        row["image"] = image.image;
        row["hash"] = io::computeContentHash(
            {reinterpret_cast<const char*>(image.bytes.data()), image.bytes.size()}
        );
    }
    if (core::Status done = json::writeJsonFile(path, root); !done)
        return core::makeError("--hash-passes: {}", done.error().message);
    return {};
}

} // namespace shutter::game
