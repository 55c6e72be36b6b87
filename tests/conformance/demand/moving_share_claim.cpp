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

struct TiledMethod {
    const char* name;
    bool isHeld; ///< against the limits; the others are shown beside
};

constexpr TiledMethod kMethods[] = {
    {"gather", true},
    {"hybrid", true},
    {"resolved", true},
    {"mcguire2012", false},
    {"guertin2014", false},
    {"jimenez2014", false},
};

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

Curve drawCurve(
    const std::string& method,
    const std::vector<RegionStage>& regions,
    const std::vector<Frames>& frames,
    const Figure& effect
) {
    Curve curve{method, method, "tiles that move", "%", "effect", "ms", {}};
    for (size_t i = 0; i < regions.size(); ++i) {
        const double percent = 100.0 * regions[i].tileShare;
        curve.points.push_back(
            {percent, summarize(frames[i], effect), fmt::format("{:.1f} %", percent)}
        );
    }
    addLine(curve);
    return curve;
}

core::Result<Findings> measureShares(gpu::Device& device, const DemandOptions& options) {
    auto regions = loadRegions(device, options);
    if (!regions)
        return regions.error();
    Findings findings;
    for (const TiledMethod& tiled : kMethods) {
        const game::MethodInfo& method = *game::findMethod(tiled.name).value();
        if (!game::canRun(method, device))
            continue;
        auto subjects = makeSubjects(device, regions.value(), tiled.name, options);
        if (!subjects)
            return subjects.error();
        auto frames = takeTurns(subjects.value(), options.rounds);
        if (!frames)
            return frames.error();
        const Figure effect = effectOf(method);
        Curve curve = drawCurve(tiled.name, regions.value(), frames.value(), effect);
        if (tiled.isHeld) {
            for (const Limit& limit : kLimits)
                findings.checks.push_back(
                    checkLimit(tiled.name, limit, regions.value(), frames.value(), effect)
                );
            findings.checks.push_back(
                checkLine(fmt::format("{}: distance from a line", tiled.name), curve)
            );
        }
        findings.curves.push_back(std::move(curve));
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
