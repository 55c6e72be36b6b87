// SPDX-License-Identifier: MIT
#include "engine/render/frame_statistics.h"

#include "engine/core/check.h"
#include "engine/math/statistics.h"

#include <algorithm>
#include <utility>

namespace shutter::render {

void addStatistics(FrameStatistics& total, const FrameStatistics& frame) {
    for (const PassTime& pass : frame.passes) {
        const auto known = std::find_if(total.passes.begin(), total.passes.end(), [&](auto& p) {
            return p.name == pass.name && p.owner == pass.owner;
        });
        if (known == total.passes.end()) {
            total.passes.push_back(pass);
            continue;
        }
        known->gpuMilliseconds += pass.gpuMilliseconds;
        known->cpuMilliseconds += pass.cpuMilliseconds;
    }
    total.cpuMilliseconds += frame.cpuMilliseconds;
    total.wallMilliseconds += frame.wallMilliseconds;
    for (const auto& [name, value] : frame.counters)
        total.counters[name] += value;
    for (const auto& [name, value] : frame.measures)
        total.measures[name] = value;
    total.explanations = frame.explanations;
    total.transientBytes = std::max(total.transientBytes, frame.transientBytes);
}

FrameStatistics computeMedian(const std::vector<FrameStatistics>& frames) {
    SHUTTER_CHECK(!frames.empty(), "a median needs a frame");
    FrameStatistics median = frames.back();
    const auto over = [&](auto pick) {
        std::vector<double> values;
        for (const auto& frame : frames)
            values.push_back(pick(frame));
        return math::computeQuartiles(std::move(values)).median;
    };
    for (size_t i = 0; i < median.passes.size(); ++i) {
        median.passes[i].gpuMilliseconds =
            over([&](const auto& frame) { return frame.passes.at(i).gpuMilliseconds; });
        median.passes[i].cpuMilliseconds =
            over([&](const auto& frame) { return frame.passes.at(i).cpuMilliseconds; });
    }
    median.cpuMilliseconds = over([](const auto& frame) { return frame.cpuMilliseconds; });
    median.wallMilliseconds = over([](const auto& frame) { return frame.wallMilliseconds; });
    return median;
}

} // namespace shutter::render
