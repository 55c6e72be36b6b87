// SPDX-License-Identifier: MIT
// Command-line options of `shutter bench`, and their interpretation.
#pragma once

#include "engine/core/result.h"
#include "engine/gpu/device.h"
#include "game/bench/suites/suite.h"
#include "game/options/render_arguments.h"
#include "game/shot/methods.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace shutter::bench {

struct BenchArguments {
    BenchArguments() { shot.size = {640, 360}; }

    game::ShotArguments shot;
    gpu::DeviceOptions device;
    std::string suite;
    std::filesystem::path out;
    std::filesystem::path rooms = "../shared/scenes"; ///< of the suite lens
    std::vector<std::string> methods;
    std::vector<std::string> cases;
    std::vector<std::string> antiAliasings; ///< empty: the suite's own
    std::optional<uint32_t> repeats;
    std::optional<double> limitSeconds;
    std::optional<uint32_t> truthSamples;
    uint32_t frames = 48;
    bool restart = false;
    bool reportOnly = false;
    std::vector<std::string> given; ///< listGivenOptions()

    std::vector<CLI::Option*> shotOptions;    ///< which only a scene of one's own has
    const CLI::Option* pixelOption = nullptr; ///< --pixel
};

/// The measurements of a run.
struct BenchTask {
    Suite suite;
    std::vector<const game::MethodInfo*> methods;
    game::ShotOptions shot;
};

void defineBenchOptions(CLI::App& command, BenchArguments& arguments);

/// The scene's file name and the options of the parsed command as they were given, "--case near",
/// in the order of its help. Left out is what has no effect on what is measured: --out, --rooms,
/// --restart and --report-only.
[[nodiscard]] std::vector<std::string> listGivenOptions(const CLI::App& command);

/// Error: names the option.
[[nodiscard]] core::Result<BenchTask> interpretBench(const BenchArguments& arguments);

} // namespace shutter::bench
