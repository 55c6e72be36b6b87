// SPDX-License-Identifier: MIT
// What a soak took of the machine over its frames, and whether that stayed flat.
#pragma once

#include "engine/gpu/device.h"
#include "tests/conformance/demand/claim.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace shutter::soak {

/// One cycle of a run, and what was held when it had ended and the device was idle.
struct CycleSample {
    uint32_t frameCount = 0;               ///< of the run until then
    std::optional<uint64_t> residentBytes; ///< nothing where the system does not say
    gpu::LivingObjects device;
    math::Quartiles wallMilliseconds;      ///< of a frame
    math::Quartiles processorMilliseconds; ///< of a frame, all threads
};

using RunSamples = std::vector<CycleSample>;

/// Cycles that a run must have to be judged: the first, in which shaders are compiled and memory is
/// taken, does not count, and the rest has a first and a last third.
inline constexpr size_t kMinCycles = 4;

/// Checks of one run: memory of the process and of the device and frame time at its end against
/// those after its first cycle. \param samples kMinCycles or more (CHECKed)
/// \param judgesProcessorTime a frame's time is that of processors, which other programs disturb
///        less, as fits a software device
[[nodiscard]] stability::Measurements
judgeRun(const std::string& run, const RunSamples& samples, bool judgesProcessorTime);

/// Memory of the process, memory of the device and frame times over the frames of all runs, one
/// after the other.
[[nodiscard]] std::vector<demand::Curve> drawCurves(const std::vector<RunSamples>& runs);

} // namespace shutter::soak
