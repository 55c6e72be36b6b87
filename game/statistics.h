// SPDX-License-Identifier: MIT
#pragma once

#include "engine/core/result.h"
#include "engine/gpu/device_select.h"
#include "engine/render/renderer.h"
#include "game/render_options.h"

#include <filesystem>
#include <vector>

namespace shutter::game {

/// Adds times pass by pass (by name and owner) and counters; explanations and measures are the
/// later frame's.
void addStatistics(render::FrameStatistics& total, const render::FrameStatistics& frame);

/// Medians pass by pass of frames that ran the same passes; the rest is the last frame's.
[[nodiscard]] render::FrameStatistics
computeMedian(const std::vector<render::FrameStatistics>& frames);

struct PictureStatistics {
    double seconds = 0.0;
    render::FrameStatistics frame;
};

/// --stats: schema in README.md, "Statistics".
[[nodiscard]] core::Status writeStatistics(
    const std::filesystem::path& path,
    const RenderOptions& options,
    const gpu::DeviceInfo& device,
    const std::vector<PictureStatistics>& pictures
);

} // namespace shutter::game
