// SPDX-License-Identifier: MIT
// A scene in which a region of the picture moves, as small or as large as one likes.
#pragma once

#include "tests/conformance/demand/subject.h"

#include <memory>
#include <string_view>
#include <vector>

namespace shutter::demand {

struct RegionStage {
    std::unique_ptr<Stage> stage;
    /// Share of the tiles in whose neighbourhood something moves by half a pixel or more, [0, 1].
    double tileShare = 0.0;
};

/// From nothing to the full screen: buildMovingRegionScene() of about 0, 1, 2, 5, 10, 25, 50, 75
/// and 100 % of the tiles, which are then counted.
[[nodiscard]] core::Result<std::vector<RegionStage>>
loadRegions(gpu::Device& device, const DemandOptions& options);

/// One subject a region, in their order.
[[nodiscard]] core::Result<Subjects> makeSubjects(
    gpu::Device& device,
    const std::vector<RegionStage>& regions,
    std::string_view method,
    const DemandOptions& options
);

} // namespace shutter::demand
