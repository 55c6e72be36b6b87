// SPDX-License-Identifier: MIT
// Vectors that are off by the same everywhere, as jitter makes them.
#include "modules/motion_blur/embedding/host_check_reading.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace shutter::motion_blur {

namespace {

using math::dvec2;

/// What is the same at nearly all that stands still, beyond the camera's part.
std::optional<dvec2> findOffset(const Reading& said) {
    std::vector<double> xs;
    std::vector<double> ys;
    size_t count = 0;
    for (const CheckPoint& point : said.points) {
        const dvec2 off = said.differenceOf(point);
        // Half floats hold longer vectors too coarsely.
        if (point.isSky || glm::length(said.cameraOf(point)) > 48.0)
            continue;
        ++count;
        if (glm::length(off) < 2.5) {
            xs.push_back(off.x);
            ys.push_back(off.y);
        }
    }
    const size_t least = std::max(kLeastPoints, count * 6 / 10);
    const auto x = takeMedian(xs, least);
    const auto y = takeMedian(ys, least);
    if (!x || !y)
        return std::nullopt;
    const dvec2 offset(*x, *y);
    const double tolerance = 0.02 + 0.12 * glm::length(offset);
    size_t near = 0;
    for (const CheckPoint& point : said.points)
        near += !point.isSky && glm::length(said.cameraOf(point)) <= 48.0 &&
                glm::length(said.differenceOf(point) - offset) <= tolerance;
    return 10 * near >= 6 * count ? std::optional(offset) : std::nullopt;
}

bool isOffsetNear(const dvec2& offset, const dvec2& wanted) {
    return glm::length(offset - wanted) <= 0.03 + 0.15 * glm::length(wanted);
}

} // namespace

void checkOffset(
    CheckedFrame& now, const CheckedFrame* last, const Reading& said, std::vector<Finding>& findings
) {
    const auto found = findOffset(said);
    if (!found)
        return;
    now.offsetPx = *found;
    now.hasOffset = true;
    const dvec2 offset = *found;
    if (glm::length(offset) < 0.1)
        return;
    const HostConvention& convention = now.facts.convention;
    const HostCameras& cameras = convention.cameras;
    // By how much jitter that is left in the vectors makes them longer.
    const dvec2 jitter = cameras.jitterPxBefore - cameras.jitterPx;
    const bool isDeclared = glm::length(jitter) >= 0.1;
    const dvec2 signY(1.0, -1.0);
    const auto tell = [&](std::string sentence) {
        findings.push_back({CheckKind::VectorOffset, std::move(sentence)});
    };
    const std::string what = fmt::format(
        "what stands still has ({:.2f}, {:.2f}) px more than the cameras imply", offset.x, offset.y
    );
    if (!now.facts.isNative && isDeclared && !convention.vectors.haveJitter &&
        isOffsetNear(offset, jitter))
        return tell(
            what + ", the change of cameras.jitterPx: jitter is left in the vectors, set "
                   "vectorsHaveJitter = true"
        );
    if (!now.facts.isNative && isDeclared && convention.vectors.haveJitter &&
        isOffsetNear(offset, -jitter))
        return tell(
            what + ", the change of cameras.jitterPx: the vectors have no jitter, set "
                   "vectorsHaveJitter = false"
        );
    if (!now.facts.isNative && isDeclared && convention.vectors.haveJitter &&
        (isOffsetNear(offset, (signY - 1.0) * jitter) ||
         isOffsetNear(offset, (-signY - 1.0) * jitter) || isOffsetNear(offset, -2.0 * jitter)))
        return tell(
            what + ": cameras.jitterPx and jitterPxBefore have the wrong sign (by how much samples "
                   "lie right and down of the pixels' centres)"
        );
    if (isDeclared && isOffsetNear(offset, -jitter))
        return tell(
            what + ", the change of cameras.jitterPx: the jitter is in cameras.clipFromView, which "
                   "must be without"
        );
    // Jitter that was not declared differs from frame to frame; what moves evenly does not.
    if (last && last->hasOffset && glm::length(offset - last->offsetPx) > 0.1 &&
        glm::length(last->offsetPx) < 2.5)
        tell(
            what + ", and another offset in the frame before: is temporal jitter left in the "
                   "vectors? Project both ends without it, or set vectorsHaveJitter and "
                   "cameras.jitterPx"
        );
}

} // namespace shutter::motion_blur
