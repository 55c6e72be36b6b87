// SPDX-License-Identifier: MIT
#include "engine/extract/motion_cap.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace shutter::extract {

namespace {

constexpr double kTolerance = 0.01;

/// Longest motion of each row's pixels; the last is the sky's.
std::vector<double>
findLongest(const image::Image& motion, const image::Image& entityId, size_t rows) {
    std::vector<double> longest(rows + 1, 0.0);
    for (uint32_t y = 0; y < motion.height; ++y)
        for (uint32_t x = 0; x < motion.width; ++x) {
            const auto id = static_cast<size_t>(entityId.at(x, y, 0));
            double& own = longest[std::min(id, rows)];
            own = std::max(own, std::hypot(double{motion.at(x, y, 0)}, double{motion.at(x, y, 1)}));
        }
    return longest;
}

/// \return whether `length` is beyond the cap; then `share` is lowered
bool tighten(double& share, double length, double maxPx) {
    if (!(length > maxPx * (1.0 + kTolerance)))
        return false;
    share *= maxPx / length;
    return true;
}

} // namespace

bool tightenCap(
    scene::MotionCap& cap,
    const ExtractedFrame& frame,
    const image::Image& motion,
    const image::Image& entityId,
    const scene::ExposureMotion& uncapped,
    double maxPx
) {
    const size_t rows = frame.entities.size();
    const std::vector<double> longest = findLongest(motion, entityId, rows);
    double still = longest[rows];
    bool isTightened = false;
    std::vector<std::pair<ecs::Entity, double>> movers;
    for (size_t row = 0; row < rows; ++row) {
        const ecs::Entity entity = frame.entityHandles[row];
        if (!uncapped.mayObjectMove(entity) && !uncapped.mayDeform(entity)) {
            still = std::max(still, longest[row]);
            continue;
        }
        const double* before = cap.findMover(entity);
        double share = before ? *before : 1.0;
        isTightened = tighten(share, longest[row], maxPx) || isTightened;
        movers.emplace_back(entity, share);
    }
    std::sort(movers.begin(), movers.end(), [](const auto& a, const auto& b) {
        return a.first.index < b.first.index;
    });
    cap.movers = std::move(movers);
    return tighten(cap.camera, still, maxPx) || isTightened;
}

} // namespace shutter::extract
