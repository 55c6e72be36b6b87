// SPDX-License-Identifier: MIT
// Motion vectors and cameras as the host declared them, or as a hypothesis about a mistake, such as
// a field of view that differs from the picture's. Included only by the checks' sources.
#pragma once

#include "engine/math/math.h"
#include "modules/motion_blur/embedding/check/checked_frame.h"

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace shutter::motion_blur {

inline constexpr size_t kMinPoints = 96;        ///< minimum number of points for a finding
inline constexpr size_t kMinInformative = 48;   ///< points at which a mistake would show
inline constexpr double kTolerancePx = 0.3;     ///< half floats, filtered depth
inline constexpr double kToleranceShare = 0.03; ///< paths are not quite straight

/// What vectors and cameras would be if the host had meant something else.
struct Hypothesis {
    std::vector<CheckPoint> points;
    math::dvec2 scale{1.0}; ///< of the motion
    bool isSwapped = false;
    bool haveCamera = true;
    std::string sentence;
    bool isAlternative = false; ///< reported together with other hypotheses that explain as much

    [[nodiscard]] math::dvec2 motionOf(const CheckPoint& point) const {
        return scale * (isSwapped ? math::dvec2(point.motion.y, point.motion.x) : point.motion);
    }

    [[nodiscard]] math::dvec2 cameraOf(const CheckPoint& point) const {
        return haveCamera ? point.camera : math::dvec2(0.0);
    }

    [[nodiscard]] math::dvec2 differenceOf(const CheckPoint& point) const {
        return motionOf(point) - cameraOf(point);
    }

    [[nodiscard]] bool agreesAt(const CheckPoint& point) const {
        const double tolerance = kTolerancePx + kToleranceShare * glm::length(cameraOf(point));
        return glm::length(differenceOf(point)) <= tolerance;
    }
};

/// The frame as declared.
[[nodiscard]] Hypothesis read(const CheckedFrame& frame, const CheckFacts& facts);
/// The frame as the host declared it.
[[nodiscard]] Hypothesis readDeclared(const CheckedFrame& frame);

/// Number of points that the hypothesis explains; nothing if it is no better than the host's
/// declaration.
[[nodiscard]] std::optional<size_t> judge(const Hypothesis& declared, const Hypothesis& candidate);

/// Points that are not the sky whose vectors are the camera's.
[[nodiscard]] size_t countAgreeing(const Hypothesis& hypothesis);

/// Nothing: there are fewer than `least`. Changes their order.
[[nodiscard]] std::optional<double> takeMedian(std::vector<double>& values, size_t least);

/// Checks for an offset shared by all static surfaces, beyond camera motion: jitter.
void checkOffset(
    CheckedFrame& now,
    const CheckedFrame* last,
    const Hypothesis& declared,
    std::vector<Finding>& findings
);

/// Factors of the first two rows of both projections that minimise the cost: both by the same, or
/// one of them. Evaluates the cost about a hundred times.
[[nodiscard]] math::dvec2 fitLens(const std::function<double(const math::dvec2&)>& cost);

/// The facts with projections whose first two rows are multiplied.
[[nodiscard]] CheckFacts scaleLens(const CheckFacts& facts, const math::dvec2& scale);

/// "cameras.clipFromView had a field of view of 60 degrees in place of 45"
[[nodiscard]] std::string describeLens(const CheckFacts& facts, const math::dvec2& scale);

} // namespace shutter::motion_blur
