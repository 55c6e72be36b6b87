// SPDX-License-Identifier: MIT
// Boxes around rows of the entity table, and whether a view sees them.
#pragma once

#include "engine/extract/extracted_frame.h"
#include "engine/math/bounds.h"
#include "engine/math/math.h"

#include <cstdint>

namespace shutter::extract {

/// Null: the row's mesh is not deformed.
[[nodiscard]] const DeformedEntity* findDeformed(const ExtractedFrame& frame, uint32_t row);

/// Object space, raster instant: the deformed mesh's where there is one.
[[nodiscard]] const math::Bounds&
findRowBounds(const ExtractedFrame& frame, const SceneLayout& layout, uint32_t row);

/// True when the box lies wholly beyond one of the side planes or behind the near plane. Depth is
/// reversed, and nothing is too far.
[[nodiscard]] bool isOutsideView(const math::dmat4& clipFromObject, const math::Bounds& bounds);

} // namespace shutter::extract
