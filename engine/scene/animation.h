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

/// A cubic in Hermite form (glTF 2.0, appendix C.5); tangents are per interval.
template <typename Value> struct HermiteSpan { Value from, outTangent, to, inTangent; };

/// \param share of the interval, [0, 1]
template <typename Value>
[[nodiscard]] Value interpolateHermite(const HermiteSpan<Value>& span, double share) {
    const double s = share;
    const double s2 = s * s;
    const double s3 = s2 * s;
    return (2.0 * s3 - 3.0 * s2 + 1.0) * span.from + (s3 - 2.0 * s2 + s) * span.outTangent +
           (3.0 * s2 - 2.0 * s3) * span.to + (s3 - s2) * span.inTangent;
}

/// Time within the clip: wrapped into [0, duration) when looping, else as it is.
[[nodiscard]] double clipSeconds(const AnimationClip& clip, bool loop, double seconds);

[[nodiscard]] bool isActive(const Playback& playback, uint32_t clip);

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
