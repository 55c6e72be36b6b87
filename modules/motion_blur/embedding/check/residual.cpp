// SPDX-License-Identifier: MIT
// Residual between vectors and cameras on static surfaces: the same everywhere, as from jitter, or
// not explained by any known mistake.
#include "modules/motion_blur/embedding/check/hypothesis.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace shutter::motion_blur {

namespace {

using math::dvec2;

/// The offset shared by nearly all static surfaces, beyond camera motion.
std::optional<dvec2> findOffset(const Hypothesis& declared) {
    std::vector<double> xs;
    std::vector<double> ys;
    size_t count = 0;
    for (const CheckPoint& point : declared.points) {
        const dvec2 off = declared.differenceOf(point);
        // Half floats hold longer vectors too coarsely.
        if (point.isSky || glm::length(declared.cameraOf(point)) > 48.0)
            continue;
        ++count;
        if (glm::length(off) < 2.5) {
            xs.push_back(off.x);
            ys.push_back(off.y);
        }
    }
    const size_t least = std::max(kMinPoints, count * 6 / 10);
    const auto x = takeMedian(xs, least);
    const auto y = takeMedian(ys, least);
    if (!x || !y)
        return std::nullopt;
    const dvec2 offset(*x, *y);
    const double tolerance = 0.02 + 0.12 * glm::length(offset);
    size_t near = 0;
    for (const CheckPoint& point : declared.points)
        near += !point.isSky && glm::length(declared.cameraOf(point)) <= 48.0 &&
                glm::length(declared.differenceOf(point) - offset) <= tolerance;
    return 10 * near >= 6 * count ? std::optional(offset) : std::nullopt;
}

bool isOffsetNear(const dvec2& offset, const dvec2& wanted) {
    return glm::length(offset - wanted) <= 0.03 + 0.15 * glm::length(wanted);
}

} // namespace

void checkOffset(
    CheckedFrame& now,
    const CheckedFrame* last,
    const Hypothesis& declared,
    std::vector<Finding>& findings
) {
    const auto found = findOffset(declared);
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
    const auto report = [&](std::string sentence) {
        findings.push_back({CheckKind::VectorOffset, std::move(sentence)});
    };
    const std::string what = fmt::format(
        "the vectors of static surfaces exceed what the cameras imply by ({:.2f}, {:.2f}) px",
        offset.x,
        offset.y
    );
    if (!now.facts.isNative && isDeclared && !convention.vectors.haveJitter &&
        isOffsetNear(offset, jitter))
        return report(
            what + ", the change of cameras.jitterPx: jitter is left in the vectors, set "
                   "vectorsHaveJitter = true"
        );
    if (!now.facts.isNative && isDeclared && convention.vectors.haveJitter &&
        isOffsetNear(offset, -jitter))
        return report(
            what + ", the change of cameras.jitterPx: the vectors have no jitter, set "
                   "vectorsHaveJitter = false"
        );
    if (!now.facts.isNative && isDeclared && convention.vectors.haveJitter &&
        (isOffsetNear(offset, (signY - 1.0) * jitter) ||
         isOffsetNear(offset, (-signY - 1.0) * jitter) || isOffsetNear(offset, -2.0 * jitter)))
        return report(
            what + ": cameras.jitterPx and jitterPxBefore have the wrong sign (by how much samples "
                   "lie right and down of the pixels' centres)"
        );
    if (isDeclared && isOffsetNear(offset, -jitter))
        return report(
            what + ", the change of cameras.jitterPx: the jitter is in cameras.clipFromView, which "
                   "must be without"
        );
    // Undeclared jitter differs from frame to frame; uniform motion does not.
    if (last && last->hasOffset && glm::length(offset - last->offsetPx) > 0.1 &&
        glm::length(last->offsetPx) < 2.5)
        report(
            what + ", and another offset in the frame before: is temporal jitter left in the "
                   "vectors? Project both ends without it, or set vectorsHaveJitter and "
                   "cameras.jitterPx"
        );
}

namespace {

using math::dvec2;

constexpr double kMinOffPx = 1.5;
constexpr double kMinOffShare = 0.15; ///< of the camera's motion

/// What of the picture is static, and how far off its vectors are.
struct Still {
    size_t count = 0;
    std::vector<double> offPx; ///< where they are off
    std::vector<double> cameraPx;
};

Still measure(const Hypothesis& declared, const std::vector<bool>& isMover) {
    Still still;
    for (const CheckPoint& point : declared.points) {
        if (point.isSky || (point.id < isMover.size() && isMover[point.id]))
            continue;
        ++still.count;
        const double camera = glm::length(declared.cameraOf(point));
        const double off = glm::length(declared.differenceOf(point));
        still.cameraPx.push_back(camera);
        if (off > kMinOffPx + kMinOffShare * camera)
            still.offPx.push_back(off);
    }
    return still;
}

} // namespace

void checkUnexplained(const CheckedFrame& now, std::vector<Finding>& findings) {
    const CheckFacts& facts = now.facts;
    if (!facts.hasVectors || !hasCameras(facts) ||
        hasFound(findings, {CheckKind::MoverUnlisted, CheckKind::Movers, CheckKind::DepthEqual}))
        return;
    // Where movers are listed, all else is static by the host's own word. Elsewhere a cockpit
    // may fill the picture, or a crowd, whose vectors are no camera's.
    const bool hasMotionInputs = facts.readsMotion && facts.hasIds;
    Still still =
        measure(readDeclared(now), hasMotionInputs ? markMovers(facts) : std::vector<bool>());
    const double share = double(still.offPx.size()) / double(std::max<size_t>(still.count, 1));
    const auto camera = takeMedian(still.cameraPx, kMinPoints);
    if (!camera || share < (hasMotionInputs ? 0.25 : 0.9) || (!hasMotionInputs && *camera < 4.0))
        return;
    findings.push_back(
        {CheckKind::Unexplained,
         fmt::format(
             "vectors are {:.3g} px off from what the cameras imply at {} of the static pixels, "
             "and no single mistake explains it: hold {}, clipFromView, depth and {} against what "
             "the picture was drawn with",
             takeMedian(still.offPx, 1).value_or(0.0),
             describeShare(share),
             facts.hasExposureCameras ? "keys" : "cameras.viewFromWorld",
             facts.isNative ? "motionDepth" : "vectors"
         )}
    );
}

} // namespace shutter::motion_blur
