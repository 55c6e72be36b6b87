// SPDX-License-Identifier: MIT
// Sample patterns: sequences that fill an interval evenly for any number of samples, and masks of
// blue noise, any threshold of which is evenly distributed over the picture, so that sampling error
// shows as fine grain only.
#pragma once

#include "engine/math/math.h"

#include <cstdint>
#include <vector>

namespace shutter::math {

/// Van der Corput radical inverse of `index` in `base`: [0, 1).
[[nodiscard]] constexpr double radicalInverse(uint32_t index, uint32_t base) {
    double result = 0.0;
    double digit = 1.0 / base;
    for (; index > 0; index /= base, digit /= base)
        result += digit * (index % base);
    return result;
}

/// Places in the unit square by Halton's sequence of bases 2 and 3 (Halton 1964).
[[nodiscard]] inline dvec2 halton23(uint32_t index) {
    return {radicalInverse(index, 2), radicalInverse(index, 3)};
}

/// A square of ranks, each of [0, side^2) once, row by row. It tiles. By void and cluster (Ulichney
/// 1993, "The void-and-cluster method for dither array generation"). In whole numbers: the same
/// bits everywhere.
/// \param side [8, 256] (CHECKed); time grows with its fourth power: 64 takes some 10 milliseconds
/// \param seed of the pattern that it starts from
[[nodiscard]] std::vector<uint32_t> makeBlueNoise(uint32_t side, uint32_t seed);

} // namespace shutter::math
