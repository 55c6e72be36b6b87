// SPDX-License-Identifier: MIT
// Whether a camera jumps: a cut that nobody announced.
#pragma once

#include "engine/math/math.h"
#include "engine/scene/components.h"

#include <functional>

namespace shutter::scene {

/// Rigid matrix (math::removeScale) of the camera at a time, seconds.
using PoseAt = std::function<math::dmat4(double seconds)>;

/// True when the pose jumps between `from` and `to` by the detection's turn or displacement or
/// more. Intervals that change so much are halved 30 times: what a smooth motion does in one
/// shrinks with it, a jump stays. A pose that is not finite is none. False where detection is off.
[[nodiscard]] bool
findsCameraCut(const PoseAt& poseAt, double from, double to, const CutDetection& detection);

} // namespace shutter::scene
