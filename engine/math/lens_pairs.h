// SPDX-License-Identifier: MIT
// Where the samples of a picture lie in the exposure and in the lens together.
#pragma once

#include "engine/math/math.h"

#include <cstdint>
#include <vector>

namespace shutter::math {

/// A time of the exposure and a place of the lens.
struct LensPair {
    double light = 0.0;    ///< share of the exposure's light that comes before, (0, 1)
    dvec2 place{0.0, 0.0}; ///< of the unit square, for shader::aperturePoint()
};

/// shader::kLensSets sets of `samples` pairs: sample i of set k is at i * kLensSets + k, and has
/// the same time in all of them. Each set is spread evenly over time and lens together; the places
/// of all are spread evenly over the lens, and so are those from k = 4 n to 4 n + 3.
/// \param samples of a set, above 0
/// \param turn of a frame among those whose mean is the picture: in kLensSets of them, one after
/// the other, each set takes the places of all sets
[[nodiscard]] std::vector<LensPair> spreadLensPairs(uint32_t samples, uint32_t turn = 0);

} // namespace shutter::math
