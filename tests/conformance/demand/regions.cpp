// SPDX-License-Identifier: MIT
#include "tests/conformance/demand/regions.h"

#include "assets/generator/scaling_scenes.h"

#include <array>
#include <cmath>

namespace shutter::demand {

namespace {

struct Region {
    int columns = 0;
    int rows = 0;
};

constexpr std::array kRegions = {
    Region{0, 0},
    Region{1, 1},
    Region{2, 1},
    Region{4, 1},
    Region{5, 2},
    Region{6, 5},
    Region{9, 7},
    Region{12, 8},
    Region{generator::kPanelColumns, generator::kPanelRows},
};

core::Result<std::unique_ptr<Stage>> loadRegion(const DemandOptions& options, Region region) {
    return loadScalingStage(
        options,
        fmt::format("region-{}x{}", region.columns, region.rows),
        [region] { return generator::buildMovingRegionScene(region.columns, region.rows); }
    );
}

/// Counted in what the method itself found.
core::Result<double>
countMovingTiles(gpu::Device& device, const Stage& stage, const DemandOptions& options) {
    constexpr float kLeastPx = 0.5f;
    auto subject = Subject::create(device, stage, "gather", options.width, options.height);
    if (!subject)
        return subject.error();
    subject.value()->setIntermediates({"tiles"});
    auto drawn = subject.value()->draw();
    if (!drawn)
        return drawn.error();
    const auto found = drawn.value().intermediates.find("tiles");
    if (found == drawn.value().intermediates.end())
        return 0.0; // the effect was not asked for: nothing moves
    const image::Image& tiles = found->second;
    uint64_t moving = 0;
    for (uint32_t y = 0; y < tiles.height; ++y)
        for (uint32_t x = 0; x < tiles.width; ++x)
            moving += std::hypot(tiles.at(x, y, 0), tiles.at(x, y, 1)) >= kLeastPx;
    return double(moving) / (double(tiles.width) * tiles.height);
}

} // namespace

core::Result<std::vector<RegionStage>>
loadRegions(gpu::Device& device, const DemandOptions& options) {
    std::vector<RegionStage> regions;
    for (const Region region : kRegions) {
        auto stage = loadRegion(options, region);
        if (!stage)
            return stage.error();
        auto share = countMovingTiles(device, *stage.value(), options);
        if (!share)
            return share.error();
        regions.push_back({std::move(stage).value(), share.value()});
    }
    return regions;
}

core::Result<Subjects> makeSubjects(
    gpu::Device& device,
    const std::vector<RegionStage>& regions,
    std::string_view method,
    const DemandOptions& options
) {
    Subjects subjects;
    for (const RegionStage& region : regions) {
        auto subject =
            Subject::create(device, *region.stage, method, options.width, options.height);
        if (!subject)
            return subject.error();
        subjects.push_back(std::move(subject).value());
    }
    return subjects;
}

} // namespace shutter::demand
