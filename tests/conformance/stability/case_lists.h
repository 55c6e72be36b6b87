// SPDX-License-Identifier: MIT
// The hard cases by what they are made of; listHardCases() joins them.
#pragma once

#include "tests/conformance/stability/measured.h"

#include <vector>

namespace shutter::stability {

/// Synthetic G-buffers: motion that is zero, tiny, huge, NaN; weights; bright colours.
[[nodiscard]] std::vector<HardCase> listMotionCases();
/// Changes too small to see: no pixel may jump.
[[nodiscard]] std::vector<HardCase> listContinuityCases();
/// Scenes whose cameras, places and shutter are hard.
[[nodiscard]] std::vector<HardCase> listPlaceCases();
/// Frames in which something has no past, and frames of no and of great length.
[[nodiscard]] std::vector<HardCase> listHistoryCases();
/// Scenes whose meshes, materials and transforms are hard.
[[nodiscard]] std::vector<HardCase> listSurfaceCases();
/// Sizes of the picture, and entities beyond the table.
[[nodiscard]] std::vector<HardCase> listLimitCases();
/// How much light a blur loses.
[[nodiscard]] std::vector<HardCase> listEnergyCases();
/// Rays that leave a surface: their own again, or through the next.
[[nodiscard]] std::vector<HardCase> listRevealCases();
/// Functions of the shaders, as C++ in single and in double precision.
[[nodiscard]] std::vector<HardCase> listFunctionPrecisionCases();
/// Passes on the device against the same in double precision.
[[nodiscard]] std::vector<HardCase> listPassPrecisionCases();
/// The same bits again and again, on one thread and on two.
[[nodiscard]] std::vector<HardCase> listRepeatCases();

} // namespace shutter::stability
