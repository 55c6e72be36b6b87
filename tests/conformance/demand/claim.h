// SPDX-License-Identifier: MIT
// "Only what the scene calls for", measured: claims about what a frame costs, each as ratios within
// one run, held against their bounds.
#pragma once

#include "engine/core/result.h"
#include "engine/gpu/device.h"
#include "tests/conformance/stability/measured.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace shutter::demand {

struct DemandOptions {
    uint32_t width = 1280;
    uint32_t height = 720;
    uint32_t rounds = 7;          ///< pictures of each variant that count, above 0
    std::filesystem::path folder; ///< generated scenes go there; it exists
};

struct Findings {
    stability::Measurements counts; ///< the same in every run
    stability::Measurements times;  ///< medians over the rounds, which other programs disturb
};

struct Claim {
    std::string name; ///< letters and digits
    std::string title;
    std::string description; ///< what is compared with what, one sentence with a full stop
    /// Error: a scene could not be written or drawn.
    std::function<core::Result<Findings>(gpu::Device&, const DemandOptions&)> measure;
};

/// Every claim there is.
[[nodiscard]] std::vector<Claim> listClaims();

[[nodiscard]] Claim makeStillClaim();
[[nodiscard]] Claim makeMovingShareClaim();
[[nodiscard]] Claim makeRevealClaim();
[[nodiscard]] Claim makeEntitiesClaim();
[[nodiscard]] Claim makeLitClaim();

} // namespace shutter::demand
