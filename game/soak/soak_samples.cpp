// SPDX-License-Identifier: MIT
#include "game/soak/soak_samples.h"

#include "engine/core/check.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <span>

namespace shutter::soak {

namespace {

using stability::Measured;
using stability::Measurements;

/// What allocators and drivers may take over a run however long: over 20,000 frames a leak of one
/// kilobyte in each is beyond it.
constexpr double kProcessBytes = double(16u << 20u);
/// What is made when it is first wanted, late in a run too: each frame in flight has a buffer of
/// its own into which a picture is read, and images with the usage that goes with it.
constexpr double kDeviceObjects = 4.0;
constexpr double kDeviceBytes = double(256u << 10u);
/// Frames of the last third against those of the first; a busy machine alone makes a tenth.
constexpr double kTimeRatio = 1.25;

using Value = std::function<double(const CycleSample&)>;

/// The cycles that are compared.
struct Ends {
    std::span<const CycleSample> early;
    std::span<const CycleSample> late;
};

Ends findEnds(const RunSamples& samples) {
    SHUTTER_CHECK(samples.size() >= kMinCycles, "{} cycles are too few", samples.size());
    const std::span<const CycleSample> counted = std::span(samples).subspan(1);
    const size_t third = counted.size() / 3;
    return {counted.first(third), counted.last(third)};
}

double findMedian(std::span<const CycleSample> samples, const Value& value) {
    std::vector<double> values;
    for (const CycleSample& sample : samples)
        values.push_back(value(sample));
    return math::computeQuartiles(std::move(values)).median;
}

double findMost(std::span<const CycleSample> samples, const Value& value) {
    double most = 0.0;
    for (const CycleSample& sample : samples)
        most = std::max(most, value(sample));
    return most;
}

double residentOf(const CycleSample& sample) {
    return double(sample.residentBytes.value_or(0));
}

void addProcessMemory(Measurements& rows, const std::string& run, const RunSamples& samples) {
    const Ends ends = findEnds(samples);
    const double early = findMedian(ends.early, residentOf);
    const double late = findMedian(ends.late, residentOf);
    Measured row{run + ": memory of the process gained", 0.0, kProcessBytes, "bytes"};
    if (samples.back().residentBytes) {
        row.samples = samples.size();
        row.worst = std::max(late - early, 0.0);
        row.note = fmt::format("from {:.1f} to {:.1f} MiB", early / 0x1p20, late / 0x1p20);
    }
    rows.push_back(std::move(row));
}

void addDeviceObjects(Measurements& rows, const std::string& run, const RunSamples& samples) {
    const Ends ends = findEnds(samples);
    const auto add = [&](const char* what, const char* unit, double bound, const Value& value) {
        const double early = findMost(ends.early, value);
        const double late = findMost(ends.late, value);
        rows.push_back(
            {fmt::format("{}: {} gained", run, what),
             std::max(late - early, 0.0),
             bound,
             unit,
             samples.size(),
             0,
             fmt::format("from {} to {}", early, late)}
        );
    };
    add("device memory", "bytes", kDeviceBytes, [](const CycleSample& s) {
        return double(s.device.memoryBytes);
    });
    const auto addCount = [&](const char* what, uint32_t gpu::LivingObjects::*count) {
        add(what, "", kDeviceObjects, [count](const CycleSample& s) {
            return double(s.device.*count);
        });
    };
    addCount("blocks of device memory", &gpu::LivingObjects::memoryBlocks);
    addCount("buffers", &gpu::LivingObjects::buffers);
    addCount("images", &gpu::LivingObjects::images);
    addCount("acceleration structures", &gpu::LivingObjects::accelerationStructures);
}

Measured judgeTime(const std::string& run, const RunSamples& samples, bool judgesProcessorTime) {
    const Value time = [judgesProcessorTime](const CycleSample& sample) {
        return judgesProcessorTime ? sample.processorMilliseconds.median
                                   : sample.wallMilliseconds.median;
    };
    const Ends ends = findEnds(samples);
    const double early = findMedian(ends.early, time);
    const double late = findMedian(ends.late, time);
    return {
        run + ": time of a frame",
        late / early,
        kTimeRatio,
        "of the first third's",
        samples.size(),
        0,
        fmt::format(
            "from {:.2f} to {:.2f} ms {}",
            early,
            late,
            judgesProcessorTime ? "of processors" : "on the wall's clock"
        )};
}

math::Quartiles makePoint(double value) {
    return {value, value, value};
}

} // namespace

Measurements judgeRun(const std::string& run, const RunSamples& samples, bool judgesProcessorTime) {
    Measurements rows;
    addProcessMemory(rows, run, samples);
    addDeviceObjects(rows, run, samples);
    rows.push_back(judgeTime(run, samples, judgesProcessorTime));
    return rows;
}

std::vector<demand::Curve> drawCurves(const std::vector<RunSamples>& runs) {
    demand::Curve process{
        "process", "Memory of the process", "frame, runs in turn", "", "resident", "MiB", {}};
    demand::Curve device{
        "device", "Memory of the device", "frame, runs in turn", "", "allocated", "MiB", {}};
    demand::Curve wall{
        "wall", "Time of a frame", "frame, runs in turn", "", "on the wall's clock", "ms", {}};
    demand::Curve processor{
        "processor",
        "Processors' time of a frame",
        "frame, runs in turn",
        "",
        "all threads",
        "ms",
        {}};
    double start = 0.0;
    for (size_t run = 0; run < runs.size(); ++run) {
        for (const CycleSample& sample : runs[run]) {
            const double x = start + sample.frameCount;
            const std::string label = fmt::format("run {}, frame {}", run + 1, sample.frameCount);
            process.points.push_back({x, makePoint(residentOf(sample) / 0x1p20), label});
            device.points.push_back(
                {x, makePoint(double(sample.device.memoryBytes) / 0x1p20), label}
            );
            wall.points.push_back({x, sample.wallMilliseconds, label});
            processor.points.push_back({x, sample.processorMilliseconds, label});
        }
        start = process.points.empty() ? 0.0 : process.points.back().x;
    }
    return {process, device, wall, processor};
}

} // namespace shutter::soak
