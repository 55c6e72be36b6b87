// SPDX-License-Identifier: MIT
// Measurements as the JSON that results.schema.json describes.
#pragma once

#include "engine/gpu/device_select.h"
#include "game/bench/contenders.h"
#include "game/bench/measure.h"
#include "game/bench/sequence_run.h"
#include "game/bench/suites/suite.h"

#include <nlohmann/json_fwd.hpp>

#include <functional>
#include <string>
#include <vector>

namespace shutter::bench {

/// Null for a method that takes no samples.
[[nodiscard]] nlohmann::json packSampleCount(uint32_t samples);

/// Quartiles of the frame's, the effect's and the wall's milliseconds.
/// \param samples at least one (CHECKed)
[[nodiscard]] nlohmann::json
describeTimes(const game::MethodInfo& method, const std::vector<Sample>& samples);

/// One case with the sweep it was measured with.
[[nodiscard]] nlohmann::json describeCase(
    const Case& shot,
    const std::vector<SamplePoint>& sweep,
    const CaseResult& result,
    const MeasureOptions& options
);

/// The picture file of a measurement, relative to the report's folder.
using ImageOf = std::function<std::string(const nlohmann::json& measurement)>;

/// Accuracy of each other method with the sample count whose frame time is nearest to the reference
/// method's at its default.
/// \param described describeCase()'s
/// \return null if the reference was not measured
[[nodiscard]] nlohmann::json compareAtEqualTime(
    const nlohmann::json& described, const std::string& reference, const ImageOf& imageOf
);

struct MeasuredPoint {
    const ScalingPoint* point = nullptr;
    CaseResult result;
};

/// A scaling axis: one series per method, with its fit.
[[nodiscard]] nlohmann::json describeAxis(
    const ScalingAxis& axis,
    const std::vector<SamplePoint>& sweep,
    const std::vector<MeasuredPoint>& points
);

[[nodiscard]] nlohmann::json describeMethods(const std::vector<const game::MethodInfo*>& methods);

/// Names of metrics and their better direction.
[[nodiscard]] nlohmann::json describeMetrics();

/// GPU milliseconds from the G-buffer to the linear picture.
[[nodiscard]] double computeFrameTime(const Sample& sample);

/// GPU milliseconds of the passes that the method adds to the sharp frame
/// (game::PassGroup::Blur).
[[nodiscard]] double computeEffectTime(const game::MethodInfo& method, const Sample& sample);

/// Processor, cores, memory and operating system.
[[nodiscard]] nlohmann::json describeMachine();

/// Name, driver and API of the Vulkan device.
[[nodiscard]] nlohmann::json describeDevice(const gpu::DeviceInfo& device);

/// The common header of every suite's results: schema and version, suite, now, that they are not
/// yet complete, revision, machine and device.
[[nodiscard]] nlohmann::json
describeOrigin(const std::string& suite, const gpu::DeviceInfo& device);

/// The source's revision when the program was built, and whether it had been changed since.
[[nodiscard]] nlohmann::json describeRevision();

/// Now, as ISO 8601 in UTC.
[[nodiscard]] std::string describeNow();

/// What Tan, Cui and Bhojan print in "Hybrid MBlur": Table 1 (quality on their shot) and Table 2
/// (GPU milliseconds per pass of three shots).
[[nodiscard]] nlohmann::json describePaperFigures();

/// Names of a film's measures and their better direction.
[[nodiscard]] nlohmann::json describeTemporalMetrics();

[[nodiscard]] nlohmann::json describeSequence(
    const SequenceCase& film, const SequenceResult& result, const SequenceOptions& options
);

} // namespace shutter::bench
