// SPDX-License-Identifier: MIT
#pragma once

#include "engine/core/result.h"
#include "engine/gpu/device_select.h"
#include "engine/render/renderer.h"
#include "game/output/render_options.h"

#include <filesystem>
#include <vector>

namespace shutter::game {

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
