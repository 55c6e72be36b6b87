// SPDX-License-Identifier: MIT
#include "game/output/statistics_file.h"

#include "engine/io/file_bytes.h"
#include "engine/scene/shutter.h"

#include <nlohmann/json.hpp>

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

core::Status writeStatistics(
    const std::filesystem::path& path,
    const RenderOptions& options,
    const gpu::DeviceInfo& device,
    const std::vector<PictureStatistics>& pictures
) {
    scene::CameraShutter shutter = options.shot.shutter;
    if (options.shot.flythrough && options.shot.isFlythroughShutter)
        io::applyShutter(*options.shot.flythrough, options.shot.frameTimes.front(), shutter);
    nlohmann::json root = {
        {"scene", options.shot.scene.string()},
        {"method", options.method.method->name},
        {"samples", options.method.samples},
        {"width", options.shot.width},
        {"height", options.shot.height},
        {"exposure_s", scene::computeExposureSeconds(shutter, options.shot.frameSeconds)},
        {"device", device.name},
        {"driver", device.driver},
        {"repeat", options.output.repeat},
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
