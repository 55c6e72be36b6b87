// SPDX-License-Identifier: MIT
// What `compare` compares: both pictures brought to the display alike.
#pragma once

#include "engine/core/result.h"
#include "engine/image/image.h"
#include "modules/tonemap/tonemap.h"

#include <string>

namespace shutter::game {

struct CompareInput {
    image::Image image;        ///< colour alone: alpha says nothing of how a picture looks
    bool isDisplay = false;    ///< values are those a display takes, sRGB
    bool isToneMapped = false; ///< they were made so here
};

/// Reads a picture. One that is not stored for a display (EXR, HDR) is tone mapped, unless `stored`
/// asks for the values as they stand. An Error names the file; channels that are no colour cannot
/// be tone mapped.
[[nodiscard]] core::Result<CompareInput>
readCompareInput(const std::string& path, bool stored, const tonemap::TonemapSettings& settings);

} // namespace shutter::game
