// SPDX-License-Identifier: MIT
// Which pixels the checker takes samples of.
#ifndef SHUTTER_CHECK_GRID_GLSL
#define SHUTTER_CHECK_GRID_GLSL

#include "motion_blur/check_shared.h"

SHUTTER_SHADER_BEGIN

/// The pixel in the middle of a cell.
SHUTTER_INLINE uvec2 checkedPixel(uvec2 cell, uvec2 sizePx) {
    return (2u * cell + 1u) * sizePx / (2u * uvec2(kCheckAcross, kCheckDown));
}

/// Columns and rows of CheckTotals::fineDepths and fineIds.
SHUTTER_INLINE uvec2 fineGrid(uvec2 sizePx) {
    return uvec2(min(sizePx.x, kCheckFineAcross), min(sizePx.y, kCheckFineDown));
}

/// The pixel in the middle of one of its cells.
SHUTTER_INLINE uvec2 finePixel(uvec2 cell, uvec2 sizePx) {
    return (2u * cell + 1u) * sizePx / (2u * fineGrid(sizePx));
}

SHUTTER_SHADER_END

#endif
