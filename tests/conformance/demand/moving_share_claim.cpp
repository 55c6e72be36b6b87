// SPDX-License-Identifier: MIT
#include "tests/conformance/demand/figures.h"
#include "tests/conformance/demand/regions.h"

#include <cmath>
#include <limits>

namespace shutter::demand {

namespace {

/// The most that a share of the tiles may cost, as a share of the full screen's cost.
struct Limit {
    double tiles = 0.0;
    double cost = 0.0;
};

constexpr Limit kLimits[] = {{0.05, 0.10}, {0.25, 0.32}};

constexpr const char* kMethods[] = {"gather", "hybrid", "resolved"};

/// At `share`, on the straight line between the regions beside it, of what one round took.
/// \param regions by rising share, from 0 to 1
double interpolate(
    const std::vector<RegionStage>& regions, const std::vector<double>& costs, double share
) {
    for (size_t i = 1; i < regions.size(); ++i) {
        const double from = regions[i - 1].tileShare;
        const double to = regions[i].tileShare;
        if (share <= to && from < to)
            return std::lerp(costs[i - 1], costs[i], (share - from) / (to - from));
    }
    return costs.back();
}

stability::Measured checkLimit(
    const std::string& method,
    const Limit& limit,
    const std::vector<RegionStage>& regions,
    const std::vector<Frames>& frames,
    const Figure& effect
) {
    const size_t rounds = frames.back().size();
    std::vector<double> ratios;
    for (size_t round = 0; round < rounds; ++round) {
        std::vector<double> costs;
        for (const Frames& one : frames)
            costs.push_back(effect(one[round]));
        const double full = costs.back();
        ratios.push_back(
            full > 0.0 ? interpolate(regions, costs, limit.tiles) / full
                       : std::numeric_limits<double>::infinity()
        );
    }
    return checkMedian(
        fmt::format("{}: {:.0f} % of the tiles move", method, 100.0 * limit.tiles),
        math::computeQuartiles(std::move(ratios)),
        limit.cost,
        "of the full screen's cost",
        rounds
    );
}

/// Medians of the effect against the share of the tiles.
std::vector<math::CurvePoint> listMedians(
    const std::vector<RegionStage>& regions, const std::vector<Frames>& frames, const Figure& effect
) {
    std::vector<math::CurvePoint> points;
    for (size_t i = 0; i < regions.size(); ++i)
        points.push_back({100.0 * regions[i].tileShare, summarize(frames[i], effect).median});
    return points;
}

core::Result<Findings> measureShares(gpu::Device& device, const DemandOptions& options) {
    auto regions = loadRegions(device, options);
    if (!regions)
        return regions.error();
    Findings findings;
    for (const char* name : kMethods) {
        const game::MethodInfo& method = *game::findMethod(name).value();
        if (!game::canRun(method, device))
            continue;
        auto subjects = makeSubjects(device, regions.value(), name, options);
        if (!subjects)
            return subjects.error();
        auto frames = takeTurns(subjects.value(), options.rounds);
        if (!frames)
            return frames.error();
        const Figure effect = effectOf(method);
        for (const Limit& limit : kLimits)
            findings.times.push_back(
                checkLimit(name, limit, regions.value(), frames.value(), effect)
            );
        findings.times.push_back(checkLine(
            fmt::format("{}: distance from a line", name),
            listMedians(regions.value(), frames.value(), effect),
            "percent of the tiles"
        ));
    }
    return findings;
}

} // namespace

Claim makeMovingShareClaim() {
    return {
        "MovingShare",
        "Cost follows the share of the screen that moves",
        "The same panels before a wall, of which more and more move: what the effect adds to the "
        "frame against the tiles in whose neighbourhood something moves.",
        measureShares};
}

} // namespace shutter::demand
