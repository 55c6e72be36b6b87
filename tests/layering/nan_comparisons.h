// SPDX-License-Identifier: MIT
// Finds tests for NaN and infinity in shaders that a compiler may drop: Vulkan lets it take it that
// no float is either, so that only a test of the bits (shaders/common/numeric.glsl) holds.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace shutter::layering {

/// "file:line compares x with itself" and the like: equality of an operand with itself, isnan() and
/// isinf(), and a comparison with a literal that all but infinity are below (from 3.4e38 on).
/// Comments do not count.
[[nodiscard]] std::vector<std::string>
findNanComparisons(std::string_view file, std::string_view text);

} // namespace shutter::layering
