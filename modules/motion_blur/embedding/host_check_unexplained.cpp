// SPDX-License-Identifier: MIT
// Vectors that agree neither with the cameras nor with any mistake that is known.
#include "modules/motion_blur/embedding/host_check_reading.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace shutter::motion_blur {

namespace {

using math::dvec2;

constexpr double kLeastOffPx = 1.5;
constexpr double kLeastOffShare = 0.15; ///< of what the camera moves

/// What of the picture stands still, and how far off its vectors are.
struct Still {
    size_t count = 0;
    std::vector<double> offPx; ///< where they are off
    std::vector<double> cameraPx;
};

Still measure(const Reading& said, const std::vector<bool>& isMover) {
    Still still;
    for (const CheckPoint& point : said.points) {
        if (point.isSky || (point.id < isMover.size() && isMover[point.id]))
            continue;
        ++still.count;
        const double camera = glm::length(said.cameraOf(point));
        const double off = glm::length(said.differenceOf(point));
        still.cameraPx.push_back(camera);
        if (off > kLeastOffPx + kLeastOffShare * camera)
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
    // Where movers are listed, all else stands still by the host's own word. Elsewhere a cockpit
    // may fill the picture, or a crowd, whose vectors are no camera's.
    const bool isSaid = facts.readsMotion && facts.hasIds;
    Still still = measure(readSaid(now), isSaid ? markMovers(facts) : std::vector<bool>());
    const double share = double(still.offPx.size()) / double(std::max<size_t>(still.count, 1));
    const auto camera = takeMedian(still.cameraPx, kLeastPoints);
    if (!camera || share < (isSaid ? 0.25 : 0.9) || (!isSaid && *camera < 4.0))
        return;
    findings.push_back(
        {CheckKind::Unexplained,
         fmt::format(
             "vectors are {:.3g} px off from what the cameras imply at {} of what stands still, "
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
