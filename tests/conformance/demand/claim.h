// SPDX-License-Identifier: MIT
// "Only what the scene calls for", measured: claims about what a frame costs, each as ratios within
// one run, held against their bounds.
#pragma once

#include "engine/core/result.h"
#include "engine/gpu/device.h"
#include "engine/math/statistics.h"
#include "tests/conformance/stability/measured.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace shutter::demand {

struct DemandOptions {
    uint32_t width = 1280;
    uint32_t height = 720;
    uint32_t rounds = 7;          ///< pictures of each variant that count, above 0
    std::filesystem::path folder; ///< generated scenes go there; it exists
};

struct Point {
    double x = 0.0;
    math::Quartiles y; ///< over the rounds
    std::string label;
};

struct Curve {
    std::string name; ///< unique in its claim; letters, digits, -
    std::string title;
    std::string xTitle;
    std::string xUnit; ///< may be empty: a count
    std::string yTitle;
    std::string yUnit;
    std::vector<Point> points;           ///< by rising x, at least one
    std::optional<math::LineFit> line{}; ///< through the medians, where it says something
};

struct Findings {
    stability::Measurements checks;
    std::vector<Curve> curves;
};

struct Claim {
    std::string name; ///< letters and digits
    std::string title;
    std::string description; ///< what is compared with what, one sentence with a full stop
    /// Error: a scene could not be written or drawn.
    std::function<core::Result<Findings>(gpu::Device&, const DemandOptions&)> measure;
};

/// Every claim there is, in the order in which the report shows them.
[[nodiscard]] std::vector<Claim> listClaims();

[[nodiscard]] Claim makeStillClaim();
[[nodiscard]] Claim makeMovingShareClaim();
[[nodiscard]] Claim makeRevealClaim();
[[nodiscard]] Claim makeEntitiesClaim();
[[nodiscard]] Claim makeFullScreenClaim();
[[nodiscard]] Claim makeMethodsClaim();
[[nodiscard]] Claim makeTraversalClaim();
[[nodiscard]] Claim makeInstantsClaim();
[[nodiscard]] Claim makeLitClaim();
[[nodiscard]] Claim makeTogglesClaim();

} // namespace shutter::demand
