// SPDX-License-Identifier: MIT
#pragma once

#include "engine/gpu/device.h"
#include "game/bench/measure.h"
#include "game/bench/sequence_run.h"
#include "game/bench/suites/suite.h"
#include "game/shot/shot_options.h"

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace shutter::bench {

struct RunOptions {
    std::vector<std::string> given; ///< the command's options, for results.json
    Suite suite;
    std::vector<const game::MethodInfo*> methods;
    game::ShotOptions shot; ///< options that the suite's cases do not set: size, tone map
    MeasureOptions measure;
    SequenceOptions sequence; ///< for suites that have sequences
};

/// Measures a suite into results.json and index.html of the report's folder, whose parts exist.
/// Error: a scene or a file; or `stop` ended the run, in which case the measurements so far remain.
[[nodiscard]] core::Status
runSuite(gpu::Device& device, const RunOptions& options, const StopQuestion& stop);

/// Makes `app` the command `shutter bench`, which leaves its exit status (game/options/program.h).
void defineBench(CLI::App& app, int& exitStatus);

} // namespace shutter::bench
