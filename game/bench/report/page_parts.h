// SPDX-License-Identifier: MIT
// Parts of the report's page: the files embedded in this program, placeholders, JSON inside a
// <script> element, bytes as text, films, and pictures: whole ones as JPEG, for an overview, and
// the parts that are shown enlarged as PNG, exact.
#pragma once

#include "engine/core/result.h"

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <string_view>

namespace shutter::bench {

/// HTML with the placeholders style, chart, results, pictures, films and scripts.
[[nodiscard]] std::string_view getReportPage();

[[nodiscard]] std::string getReportStyle();

/// Chart.js with its licence notice; empty where the program was built without it.
[[nodiscard]] std::string_view getChartJs();

/// The page's own scripts, one after another: they run as one ECMAScript module.
[[nodiscard]] std::string joinReportScripts();

/// Replaces each `{{name}}` of `page` by its value. Inserted text is not searched again, so a value
/// may contain braces. Error: a placeholder without a value, a value without a placeholder, or `{{`
/// without `}}`.
[[nodiscard]] core::Result<std::string>
fillPage(std::string_view page, const std::map<std::string, std::string_view>& values);

/// JSON text with the same meaning that is safe inside a <script> element: it holds no `<`, so it
/// can neither end the element nor open a comment, and no line separator (U+2028, U+2029).
[[nodiscard]] std::string escapeForScript(std::string_view json);

/// RFC 4648, section 4: the standard alphabet, padded, without line breaks.
[[nodiscard]] std::string encodeBase64(std::span<const uint8_t> bytes);

/// Input of the page's scripts: `whole`, path to data URI; `parts`, path to an array of {x, y,
/// width, height, uri}. Error: a file is missing, outside `folder` or no PNG, or a crop lies
/// outside its picture.
[[nodiscard]] core::Result<nlohmann::json>
encodePictures(const nlohmann::json& results, const std::filesystem::path& folder);

/// Path to data URI of every film that `results` name (fields `film`, at any depth), relative to
/// `folder`. Error: one is missing, lies outside of the folder, is no WebM or is larger than 64
/// MiB.
[[nodiscard]] core::Result<nlohmann::json>
embedFilms(const nlohmann::json& results, const std::filesystem::path& folder);

} // namespace shutter::bench
