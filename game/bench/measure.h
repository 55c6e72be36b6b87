// SPDX-License-Identifier: MIT
// Draws one case's pictures: interleaved rounds over methods and sample counts, each compared with
// the truth once and timed several times.
#pragma once

#include "engine/core/progress.h"
#include "engine/core/result.h"
#include "engine/gpu/device.h"
#include "game/bench/contenders.h"
#include "game/bench/crops.h"
#include "game/bench/journal.h"
#include "game/bench/suites/suite.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace shutter::bench {

struct MeasureOptions {
    uint32_t repeats = 7;
    double limitSeconds = 60.0; ///< of one picture; sample counts that take longer are skipped
    uint32_t truthSamples = 256;
    std::filesystem::path folder;     ///< of the report: scenes/, images/ and journal/ go into it
    std::filesystem::path truthCache; ///< cached truth pictures by content; empty: none
    bool comparePictures = true;      ///< false: times only
};

/// Everything known of a case.
struct CaseResult {
    std::string truthImage;  ///< relative to the report's folder; empty where nothing was compared
    std::string truthLinear; ///< likewise, the linear picture
    std::string truthHash;   ///< of everything the truth depends on
    std::map<std::string, Record> records; ///< by makeKey()
    std::vector<Crop> crops;
};

/// Called between pictures; true ends the run.
using StopQuestion = std::function<bool()>;

/// Work of a case for a progress bar, in frames and rays.
[[nodiscard]] uint64_t
countSteps(const std::vector<SamplePoint>& sweep, const MeasureOptions& options);

/// A measurement's picture, relative to the report's folder.
[[nodiscard]] std::string
pictureFile(const std::string& caseName, const std::string& method, uint32_t samples);

/// "method/samples".
[[nodiscard]] std::string makeKey(const SamplePoint& point);

/// Measures the points that the case's journal lacks. Returns early, without an error, if `stop` is
/// set.
/// Error: the scene cannot be loaded, a file cannot be written.
[[nodiscard]] core::Result<CaseResult> measureCase(
    gpu::Device& device,
    const Case& shot,
    const std::vector<SamplePoint>& sweep,
    const MeasureOptions& options,
    core::Progress& progress,
    const StopQuestion& stop
);

} // namespace shutter::bench
