// SPDX-License-Identifier: MIT
// Draws one sequence by every method, compares each frame with its truth, and makes films of it.
#pragma once

#include "engine/core/progress.h"
#include "engine/core/result.h"
#include "engine/gpu/device.h"
#include "engine/io/video.h"
#include "game/bench/journal.h"
#include "game/bench/measure.h"
#include "game/bench/sequence_pass.h"
#include "game/bench/sequence_plan.h"
#include "game/bench/suites/suite.h"

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace shutter::bench {

struct SequenceOptions {
    uint32_t frames = 48; ///< of each film, 2 or more
    SequenceTruth truth{};
    std::filesystem::path folder; ///< of the report: scenes/, journal/, films/ and frames/
    std::optional<io::VideoEncoder> encoder; ///< nothing: no films are made
};

/// A method that did not draw the film.
struct SkippedMethod {
    const game::MethodInfo* method = nullptr;
    std::string reason; ///< a sentence without a full stop
};

/// Everything known of a sequence.
struct SequenceResult {
    SequencePlan plan;
    std::vector<SkippedMethod> skipped;
    bool hasLens = false; ///< SequenceSource::hasLens()
    double framesPerSecond = 24.0;
    std::map<std::string, Record> records;    ///< by makeFrameKey()
    std::map<std::string, std::string> films; ///< by makeKey(), relative to the report's folder
};

/// Measures the frames that the sequence's journal lacks. Returns early, without an error, if
/// `stop` is set.
/// Error: a scene cannot be loaded, a file cannot be written.
[[nodiscard]] core::Result<SequenceResult> measureSequence(
    gpu::Device& device,
    const SequenceCase& film,
    const std::vector<const game::MethodInfo*>& methods,
    const SequenceOptions& options,
    core::Progress& progress,
    const StopQuestion& stop
);

} // namespace shutter::bench
