// SPDX-License-Identifier: MIT
// What a report shows, inside its page: films, and pictures: whole ones as JPEG, for an overview,
// and the parts that are shown enlarged as PNG, exact.
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

/// Path to data URI of every film that `results` name (fields `film`, at any depth), relative to
/// `folder`. Error: one is missing, lies outside of the folder, is no WebM or is larger than 64
/// MiB.
[[nodiscard]] core::Result<nlohmann::json>
embedFilms(const nlohmann::json& results, const std::filesystem::path& folder);

} // namespace shutter::bench
