// SPDX-License-Identifier: MIT
// A shutter's response, as points with straight lines between them, in the form that shaders take
// their sample times from.
#pragma once

#include "shaders/common/shutter_response_shared.h"

#include <optional>
#include <span>

namespace shutter::math {

/// The sensor's sensitivity at a shutter time.
struct ResponsePoint {
    double s = 0.0; ///< shutter time, [0, 1]: 0 open, 1 close
    double sensitivity = 0.0;
};

/// Nothing for a constant response, such as a box, which needs no table.
/// \param points 2 to kMaxResponseKnots; s rises from 0 to 1, in single precision, too;
/// sensitivities are finite, 0 or more, and not all 0
[[nodiscard]] std::optional<shader::ResponseTable>
makeResponseTable(std::span<const ResponsePoint> points);

} // namespace shutter::math
