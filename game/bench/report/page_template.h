// SPDX-License-Identifier: MIT
// Text into a page of HTML: placeholders, and JSON inside a <script> element.
#pragma once

#include "engine/core/result.h"

#include <map>
#include <string>
#include <string_view>

namespace shutter::bench {

/// Replaces each `{{name}}` of `page` by its value. What is put in is not searched again, so a
/// value may hold braces. Error: a placeholder without a value, a value without a placeholder, or
/// `{{` without `}}`.
[[nodiscard]] core::Result<std::string>
fillPage(std::string_view page, const std::map<std::string, std::string_view>& values);

/// JSON text that means the same and can stand inside a <script> element: it holds no `<`, so it
/// can neither end the element nor open a comment, and no line separator (U+2028, U+2029).
[[nodiscard]] std::string escapeForScript(std::string_view json);

} // namespace shutter::bench
