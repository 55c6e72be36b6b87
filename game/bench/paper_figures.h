// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json_fwd.hpp>

namespace shutter::bench {

/// What Tan, Cui and Bhojan print in "Hybrid MBlur": Table 1 (quality on their shot) and Table 2
/// (GPU milliseconds a pass of three shots).
[[nodiscard]] nlohmann::json describePaperFigures();

} // namespace shutter::bench
