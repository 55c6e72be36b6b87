// SPDX-License-Identifier: MIT
#include "game/bench/sequence_plan.h"

#include "game/bench/measure.h"

#include <fmt/format.h>

#include <algorithm>

namespace shutter::bench {

namespace {

/// Frames in which other sample counts are drawn as well.
constexpr uint32_t kSweepFrames = 4;
/// Between two frames of which HDR-FLIP is taken.
constexpr uint32_t kFramesPerLinear = 4;
/// Largest sample count of methods that count rays: more take seconds a frame.
constexpr uint32_t kMaxRays = 8;

} // namespace

bool SequencePlan::isSwept(uint32_t frame) const {
    return std::find(sweepFrames.begin(), sweepFrames.end(), frame) != sweepFrames.end();
}

bool SequencePlan::isJudgedLinear(SequenceCamera camera, uint32_t frame) {
    return camera == SequenceCamera::Own && frame % kFramesPerLinear == 0;
}

SequencePlan planSequence(
    const std::vector<const game::MethodInfo*>& methods,
    uint32_t frames,
    uint32_t truthInstants,
    game::AntiAliasing antiAliasing
) {
    SequencePlan plan;
    const bool isAliased = antiAliasing == game::AntiAliasing::None;
    plan.points = isAliased ? makeSequencePoints(methods) : makeAntiAliasedPoints(methods);
    // Anti-aliasing draws additional frames: one sample count is enough.
    for (const SamplePoint& point :
         isAliased ? makeSweep(methods, kMaxRays) : std::vector<SamplePoint>()) {
        // The truth would be compared with itself.
        if (point.method->family == game::MethodFamily::Accumulate &&
            point.samples >= truthInstants)
            continue;
        const auto isDrawn = [&](const SamplePoint& other) {
            return makeKey(other) == makeKey(point);
        };
        if (std::none_of(plan.points.begin(), plan.points.end(), isDrawn))
            plan.sweep.push_back(point);
    }
    plan.frames = frames;
    plan.standingFrames = std::max(frames / 4, 2u);
    plan.firstStanding = (frames - plan.standingFrames) / 2;
    for (uint32_t i = 0; i < kSweepFrames; ++i) {
        const uint32_t frame = frames * (2 * i + 1) / (2 * kSweepFrames);
        if (plan.sweepFrames.empty() || plan.sweepFrames.back() != frame)
            plan.sweepFrames.push_back(frame);
    }
    return plan;
}

uint64_t countPictures(const SequencePlan& plan) {
    const uint64_t frames = uint64_t(plan.frames) + plan.standingFrames;
    return frames * (plan.points.size() + 1) + plan.sweepFrames.size() * plan.sweep.size();
}

std::string makeFrameKey(SequenceCamera camera, const std::string& point, uint32_t frame) {
    return fmt::format(
        "{}/{}/{}", camera == SequenceCamera::Own ? "own" : "standing", point, frame
    );
}

} // namespace shutter::bench
