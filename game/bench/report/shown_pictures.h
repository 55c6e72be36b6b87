// SPDX-License-Identifier: MIT
// Which picture files a run's results show, and how much of each.
#pragma once

#include "engine/core/result.h"

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace shutter::bench {

/// Pixels from the upper left corner of a picture.
struct PictureRegion {
    uint32_t x = 0;
    uint32_t y = 0;
    uint32_t width = 0;
    uint32_t height = 0;
};

/// Files are named as the results name them, relative to their folder.
struct ShownPictures {
    std::set<std::string> whole; ///< PNG: `image` and `errorMap`, wherever they are
    /// The regions of PNG that are shown enlarged: those of a case in its `image`s. Of a row at
    /// equal time whose sample count is no default, the first is all that is shown.
    std::map<std::string, std::vector<PictureRegion>> crops;
};

/// Error: a crop is not four numbers above or equal to 0, or has no pixels.
[[nodiscard]] core::Result<ShownPictures> findShownPictures(const nlohmann::json& results);

} // namespace shutter::bench
