// SPDX-License-Identifier: MIT
#pragma once

#include "engine/core/result.h"

#include <nlohmann/json_fwd.hpp>

#include <filesystem>

namespace shutter::bench {

/// Path to data URI of every film that `results` name (fields `film`, at any depth), relative to
/// `folder`. Error: one is missing, lies outside of the folder, is no WebM or is larger than 64
/// MiB.
[[nodiscard]] core::Result<nlohmann::json>
embedFilms(const nlohmann::json& results, const std::filesystem::path& folder);

} // namespace shutter::bench
