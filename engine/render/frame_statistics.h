// SPDX-License-Identifier: MIT
// Times, counters and decisions of a frame.
#pragma once

#include "engine/gpu/frame.h"
#include "engine/render/explainer.h"

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace shutter::render {

/// Numbers an effect reports about a frame, e.g. "rays traced".
using Counters = std::map<std::string, uint64_t>;
/// Figures an effect measures, e.g. "standard error"; a later frame's replaces an earlier one's.
using Measures = std::map<std::string, double>;

/// Time of one pass and its owner.
struct PassTime : gpu::PassTime {
    PassOwner owner = PassOwner::Scene;
};

struct FrameStatistics {
    std::vector<PassTime> passes;  ///< in execution order
    double cpuMilliseconds = 0.0;  ///< extraction, declaring, compiling, recording
    double wallMilliseconds = 0.0; ///< the whole frame, including the wait for the GPU
    /// The effects' counters, and "entity rows written" and "entity motions written".
    Counters counters;
    /// The effects' measures, and the CPU's part of cpuMilliseconds for "extraction ms", "entity
    /// table ms" and "TLAS ms".
    Measures measures;
    std::vector<Explanation> explanations; ///< in the order in which things were decided
    uint64_t transientBytes = 0;           ///< memory of the graph's images
};

/// Adds times pass by pass (passes are the same where name and owner are) and counters. Measures
/// and explanations are the later frame's; transientBytes is the larger one.
void addStatistics(FrameStatistics& total, const FrameStatistics& frame);

/// Medians pass by pass of frames that ran the same passes; the rest is the last frame's.
/// \param frames at least one (CHECKed)
[[nodiscard]] FrameStatistics computeMedian(const std::vector<FrameStatistics>& frames);

} // namespace shutter::render
