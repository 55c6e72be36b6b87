// SPDX-License-Identifier: MIT
// Masks of blue noise: values that are evenly spread over the picture, whichever share of them is
// taken, so that what they vary shows as fine grain only.
#pragma once

#include <cstdint>
#include <vector>

namespace shutter::math {

/// A square of ranks, each of [0, side^2) once, row by row. It tiles. By void and cluster (Ulichney
/// 1993, "The void-and-cluster method for dither array generation"). In whole numbers: the same
/// bits everywhere.
/// \param side [8, 256] (CHECKed); time grows with its fourth power: 64 takes some 10 milliseconds
/// \param seed of the pattern that it starts from
[[nodiscard]] std::vector<uint32_t> makeBlueNoise(uint32_t side, uint32_t seed);

} // namespace shutter::math
