// SPDX-License-Identifier: MIT
// Blurs pictures that any renderer made.
#pragma once

#include "engine/core/result.h"
#include "engine/gpu/device.h"
#include "game/blur/passes.h"
#include "game/blur/picture_frame.h"
#include "modules/motion_blur/settings.h"
#include "modules/tonemap/tonemap.h"

#include <filesystem>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace shutter::blur {

struct BlurOptions {
    PassFiles files;               ///< patterns of a sequence: game::frameFile()
    std::filesystem::path cameras; ///< empty: none
    std::filesystem::path out;
    std::vector<std::string> aovs; ///< names of intermediates, or "all", to write next to `out`
    int firstFrame = 0;
    int lastFrame = 0;
    bool isSequence = false; ///< names are patterns; complete frames are skipped
    bool restart = false;    ///< unless this is set
    PassOptions passes;
    PictureShutter shutter;
    motion_blur::MotionBlurSettings settings;
    tonemap::TonemapSettings tonemap; ///< of .png and .jpg; those of 8 or 16 bits stay as they are
    std::string fingerprint;          ///< differs wherever the options do
};

/// Error: names the file at fault; frames before it have been written.
[[nodiscard]] core::Status blur(const BlurOptions& options, gpu::Device& device);

/// Adds `shutter blur`, which leaves its exit status (game/options/program.h).
void addBlurCommand(CLI::App& app, int& exitStatus);

} // namespace shutter::blur
