// SPDX-License-Identifier: MIT
// Command-line options of `shutter render`, and their interpretation.
#pragma once

#include "engine/core/result.h"
#include "game/options/method_arguments.h"
#include "game/options/shot_arguments.h"
#include "game/output/render_options.h"

#include <cstdint>
#include <optional>
#include <string>

namespace shutter::game {

struct OutputArguments {
    std::string out;
    std::string ffmpeg;
    bool keepFrames = false;
    std::optional<io::VideoCodec> codec; ///< else H.264
    std::optional<uint32_t> bitDepth;    ///< else 8, of ProRes 10
    std::string timecode;                ///< "HH:MM:SS:FF" or "frame"; empty: none
    bool restart = false;
    std::string aov; ///< names, comma-separated, or "all"
    std::string stats;
    std::string hashPasses;
    bool dumpGraph = false;
    bool explain = false;
    uint32_t repeat = 1;
    std::string part; ///< "K/N"; empty: all frames
    bool dryRun = false;
};

struct RenderArguments {
    ShotArguments shot;
    MethodArguments method;
    OutputArguments output;
    gpu::DeviceOptions device;
};

void defineDeviceOptions(CLI::App& command, gpu::DeviceOptions& options);
/// All of `shutter render`.
void defineRenderOptions(CLI::App& command, RenderArguments& arguments);

/// Checks everything that needs no file; continued by loadFlythrough(). Error: names the option
/// that was used wrongly.
[[nodiscard]] core::Result<RenderOptions> interpret(const RenderArguments& arguments);

} // namespace shutter::game
