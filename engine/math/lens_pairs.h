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

/// Point `index` of `count` (more than `index`) that are spread evenly over the unit square, and
/// over a disc by shader::aperturePoint(): Sobol's first two dimensions with a digital shift, as
/// fractions of 2^32 at the corner of a stratum of 1 / count, if that is a power of two.
[[nodiscard]] uvec2 lensPoint(uint32_t index, uint32_t count);

/// shader::kLensSets sets of `samples` pairs: sample i of set k is at i * kLensSets + k, and has
/// the same time in all of them. Each set is spread evenly over time and lens together; the places
/// of all are spread evenly over the lens, and so are those from k = 4 n to 4 n + 3.
/// \param samples of a set, above 0
/// \param turn of a frame among those whose mean is the picture: in kLensSets of them, one after
/// the other, each set takes the places of all sets
[[nodiscard]] std::vector<LensPair> spreadLensPairs(uint32_t samples, uint32_t turn = 0);

} // namespace shutter::math
