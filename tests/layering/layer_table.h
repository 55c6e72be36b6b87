// SPDX-License-Identifier: MIT
// The order of dependence as a table: core -> math -> {ecs | gpu | image} -> {graph | scene} -> io
// -> render -> {app | modules} -> game. Lower never sees higher, siblings never see each other.
#pragma once

#include "tests/layering/include_reader.h"

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace shutter::layering {

/// Whether a path from the repository root is a file there.
using FileExists = std::function<bool(const std::string&)>;

/// The folders of engine/ that the table has a row for, lowest first.
[[nodiscard]] const std::vector<std::string_view>& engineFolders();

/// "file:line includes X: why not", or nothing when the table allows it. An include is searched in
/// its file's folder, from the root and from shaders/, as compilers do.
[[nodiscard]] std::optional<std::string>
findViolation(const Include& include, const FileExists& exists);

} // namespace shutter::layering
