// SPDX-License-Identifier: MIT
// Sequences of numbers that fill an interval evenly, however many are taken.
#pragma once

#include "engine/math/math.h"

#include <cstdint>

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

} // namespace shutter::math
