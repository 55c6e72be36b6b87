// SPDX-License-Identifier: MIT
#pragma once

#include "engine/math/transform.h"
#include "engine/scene/assets.h"
#include "engine/scene/components.h"
#include "engine/scene/world.h"

namespace shutter::scene {

/// The channel's value at `seconds`, clamped to its keys (glTF 2.0, appendix C): STEP, LINEAR
/// (rotations by slerp along the shorter arc), CUBICSPLINE (Hermite, rotations normalised).
[[nodiscard]] math::dvec4 sampleChannel(const AnimationChannel& channel, double seconds);

/// `rest` with the animated properties replaced by their values at `seconds`. Honours
/// `playback.activeClips` and `playback.loop`; of several clips that drive one property the
/// later one wins.
[[nodiscard]] math::Transform sampleAnimated(
    const Assets& assets,
    const Playback& playback,
    const Animated& animated,
    const math::Transform& rest,
    double seconds
);

} // namespace shutter::scene
