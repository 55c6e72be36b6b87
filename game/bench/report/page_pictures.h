// SPDX-License-Identifier: MIT
// The pictures of a report inside its page: whole ones as JPEG, for an overview, and the parts that
// are shown enlarged as PNG, exact.
#pragma once

#include "engine/core/result.h"

#include <nlohmann/json_fwd.hpp>

#include <filesystem>

namespace shutter::bench {

/// What the page's scripts read: `whole`, path to data URI; `parts`, path to an array of
/// {x, y, width, height, uri}. Error: a file is missing, outside `folder` or no PNG, or a crop lies
/// outside its picture.
[[nodiscard]] core::Result<nlohmann::json>
encodePictures(const nlohmann::json& results, const std::filesystem::path& folder);

} // namespace shutter::bench
