// SPDX-License-Identifier: MIT
// Draws the frames of a dump again, as the host drew them or by another method.
#pragma once

#include "engine/core/result.h"
#include "engine/gpu/device.h"
#include "modules/motion_blur/settings.h"

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace shutter::replay {

struct ReplayOptions {
    std::filesystem::path folder;
    std::filesystem::path out; ///< empty: nothing is written
    /// Names of intermediates, or "all", to write next to `out`.
    std::vector<std::string> aovs;
    bool explains = false;
    /// HostInputs::showsInputs of each frame: pictures then are not compared with the host's.
    bool showsInputs = false;
    /// Changes the settings of a frame; empty: they stay. Error: names the option.
    std::function<core::Status(motion_blur::MotionBlurSettings&)> change;
};

/// Prints a line for each frame: how far its picture is from the host's. Error: names the file or
/// option at fault; pictures of the frames before it may have been written.
[[nodiscard]] core::Status replay(const ReplayOptions& options, gpu::Device& device);

/// Adds `shutter replay`, which leaves its exit status (game/options/program.h).
void addReplayCommand(CLI::App& app, int& exitStatus);

} // namespace shutter::replay
