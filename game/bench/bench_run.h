// SPDX-License-Identifier: MIT
#pragma once

#include "engine/gpu/device.h"
#include "game/bench/measure.h"
#include "game/bench/sequence_run.h"
#include "game/bench/suites/suite.h"
#include "game/shot/shot_options.h"

#include <nlohmann/json_fwd.hpp>

#include <filesystem>
#include <vector>

namespace CLI {
class App;
}

namespace shutter::bench {

struct RunOptions {
    Suite suite;
    std::vector<const game::MethodInfo*> methods;
    game::ShotOptions shot; ///< what the suite's cases leave open: size, tone map
    MeasureOptions measure;
    SequenceOptions sequence; ///< for suites that have sequences
    /// Where the results go when all is measured, in place of results.json and the page, whatever
    /// left its bounds: those of a part. Empty: it is no part.
    std::filesystem::path partFile;
};

/// Error: names the hard cases or claims of results that left their bounds.
[[nodiscard]] core::Status judgeResults(const nlohmann::json& results);

/// Writes results.json of a report's folder and its page, unless the program makes none.
[[nodiscard]] core::Status
writeReport(const nlohmann::json& results, const std::filesystem::path& folder);

/// Measures a suite into results.json and index.html of the report's folder, whose parts exist.
/// Error: a scene or a file; that `stop` ended it, which leaves what was measured; or, once all is
/// written, that a hard case or a claim left its bounds.
[[nodiscard]] core::Status
runSuite(gpu::Device& device, const RunOptions& options, const StopQuestion& stop);

/// Adds `shutter bench`, which leaves its exit status (game/options/program.h).
void addBenchCommand(CLI::App& app, int& exitStatus);

} // namespace shutter::bench
