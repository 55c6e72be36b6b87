// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

namespace shutter::game {

/// Where the middle half of repeated measurements lies.
struct Quartiles {
    double median = 0.0;
    double q1 = 0.0; ///< a quarter of the values is at most this
    double q3 = 0.0; ///< three quarters are
};

/// Linear between the two nearest values (type 7 of Hyndman and Fan 1996, as NumPy and R do).
/// \param values at least one (CHECKed)
[[nodiscard]] Quartiles computeQuartiles(std::vector<double> values);

} // namespace shutter::game
