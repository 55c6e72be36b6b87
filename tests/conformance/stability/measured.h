// SPDX-License-Identifier: MIT
// What a check of numerical stability found, beside what it may find.
#pragma once

#include "engine/core/result.h"
#include "engine/gpu/device.h"

#include <fmt/format.h>

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace shutter::stability {

struct Measured {
    std::string check;      ///< what was measured
    double worst = 0.0;     ///< largest error of all samples, `unit`
    double bound = 0.0;     ///< largest error that passes, `unit`
    std::string unit;       ///< e.g. "half ulp"; empty: a count
    uint64_t samples = 0;   ///< values, pixels or rays that were looked at; 0 fails
    uint64_t notFinite = 0; ///< NaN and infinities among them; any fails
    std::string note{};     ///< where the worst was met; may be empty
};

[[nodiscard]] inline bool holds(const Measured& measured) {
    // Written so that NaN fails.
    return measured.samples > 0 && measured.notFinite == 0 && measured.worst <= measured.bound;
}

/// "0.25 half ulp of at most 1 (gather)".
[[nodiscard]] inline std::string describe(const Measured& measured) {
    return fmt::format(
        "{:.6g}{}{} of at most {:.6g}{}{}",
        measured.worst,
        measured.unit.empty() ? "" : " ",
        measured.unit,
        measured.bound,
        measured.notFinite > 0 ? fmt::format(", {} not finite", measured.notFinite) : "",
        measured.note.empty() ? "" : " (" + measured.note + ")"
    );
}

using Measurements = std::vector<Measured>;

/// A hard case: something a scene or an engine may hand to the effect.
struct HardCase {
    std::string name; ///< letters and digits; a test's name
    std::string title;
    std::string description; ///< what is drawn and why it is hard, one sentence with a full stop
    /// Error: a picture could not be drawn.
    std::function<core::Result<Measurements>(gpu::Device&)> measure;
};

/// Every row of "Hard cases" of the design, in its order.
[[nodiscard]] std::vector<HardCase> listHardCases();

} // namespace shutter::stability
