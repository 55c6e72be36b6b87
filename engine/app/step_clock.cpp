// SPDX-License-Identifier: MIT
#include "engine/app/step_clock.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace shutter::app {

namespace {

/// Steps that sums of roundings may be short of: a frame of exactly two steps takes two.
constexpr double kSlack = 1e-6;

} // namespace

void StepClock::setSpeed(double speed) {
    mSpeed = std::clamp(speed, 0.01, 4.0);
}

FrameTime StepClock::advance(double wallSeconds) {
    // Written so that NaN counts as 0.
    double seconds = wallSeconds > 0.0 ? std::min(wallSeconds, kMaxCatchUpSeconds) * mSpeed : 0.0;
    if (mPaused)
        seconds = 0.0;
    seconds += std::exchange(mPendingSeconds, 0.0);
    FrameTime frame;
    mSeconds += seconds;
    // Enough steps to reach the time to draw; the picture interpolates between the last two.
    const auto wanted = static_cast<uint64_t>(std::ceil(mSeconds / mStepSeconds - kSlack));
    frame.steps = static_cast<uint32_t>(wanted - mSteps);
    mSteps = wanted;
    if (seconds > 0.0)
        mDuration = seconds;
    frame.seconds = mSeconds;
    frame.duration = mDuration;
    return frame;
}

} // namespace shutter::app
