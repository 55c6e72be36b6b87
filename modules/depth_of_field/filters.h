// SPDX-License-Identifier: MIT
// Published filters that blur a sharp picture by its depth, as data. Each lives in a file of
// filters/.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace shutter::depth_of_field {

struct Filter {
    const char* name;        ///< of its file
    const char* publication; ///< authors and year
    bool tracesRays = false; ///< it reads what LensRays writes, too
    /// Code of a compute shader that reads the picture, motion and depth, and reach (reach.comp),
    /// and writes the filtered picture.
    std::span<const uint32_t> spirv;
};

/// The filter of that name, which must exist (CHECKed).
[[nodiscard]] const Filter& getFilter(std::string_view name);

} // namespace shutter::depth_of_field
