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
    /// PNG of which no more is shown than the first crop of their case: rows at equal time whose
    /// sample count is no default.
    std::map<std::string, PictureRegion> parts;
    /// EXR, `linear`: and the crops of their case.
    std::map<std::string, std::vector<PictureRegion>> linear;
};

/// Error: a crop is not four numbers above or equal to 0, or has no pixels.
[[nodiscard]] core::Result<ShownPictures> findShownPictures(const nlohmann::json& results);

} // namespace shutter::bench
