// SPDX-License-Identifier: MIT
// Another field of view than the picture was drawn with; the checks' own files alone include this.
#pragma once

#include "engine/math/math.h"
#include "modules/motion_blur/embedding/host_check.h"

#include <functional>
#include <string>

namespace shutter::motion_blur {

/// What the first two rows of both projections must be multiplied by for the least cost: both by
/// the same, or one of them. Evaluates the cost about a hundred times.
[[nodiscard]] math::dvec2 fitLens(const std::function<double(const math::dvec2&)>& cost);

/// The facts with projections whose first two rows are multiplied.
[[nodiscard]] CheckFacts scaleLens(const CheckFacts& facts, const math::dvec2& scale);

/// "cameras.clipFromView had a field of view of 60 degrees in place of 45"
[[nodiscard]] std::string describeLens(const CheckFacts& facts, const math::dvec2& scale);

} // namespace shutter::motion_blur
