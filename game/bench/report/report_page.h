// SPDX-License-Identifier: MIT
// The benchmark's report: results (README.md, "results.json") as one self-contained HTML file,
// without network access or separate pictures.
#pragma once

#include "engine/core/result.h"

#include <nlohmann/json_fwd.hpp>

#include <filesystem>

namespace shutter::bench {

/// Error: the program was built without Chart.js; names the package.
[[nodiscard]] core::Status checkReportPageCanBeMade();

/// Writes folder/index.html, atomically, with every film and picture that `results` names (files
/// relative to `folder`) inside it (page_parts.h). Error: no Chart.js, `results` is not of this
/// schema and version, a file is missing or of another type than its name suggests, or the page
/// cannot be written.
[[nodiscard]] core::Status
writeReportPage(const nlohmann::json& results, const std::filesystem::path& folder);

/// The same from folder/results.json. Error: also where that file is missing or is not JSON.
[[nodiscard]] core::Status remakeReportPage(const std::filesystem::path& folder);

} // namespace shutter::bench
