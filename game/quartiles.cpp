// SPDX-License-Identifier: MIT
#include "game/quartiles.h"

#include "engine/core/check.h"

#include <algorithm>
#include <cmath>

namespace shutter::game {

Quartiles computeQuartiles(std::vector<double> values) {
    SHUTTER_CHECK(!values.empty(), "quartiles of nothing");
    std::sort(values.begin(), values.end());
    const auto at = [&](double share) {
        const double position = share * double(values.size() - 1);
        const auto below = static_cast<size_t>(position);
        const size_t above = std::min(below + 1, values.size() - 1);
        return std::lerp(values[below], values[above], position - double(below));
    };
    return {at(0.5), at(0.25), at(0.75)};
}

} // namespace shutter::game
