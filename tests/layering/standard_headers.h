// SPDX-License-Identifier: MIT
// Finds names of the standard library whose header no file of this tree includes: they compile for
// as long as another header happens to bring them, which differs between releases of a compiler.
#pragma once

#include "tests/layering/include_reader.h"

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace shutter::layering {

/// One file's text as far as this test reads it.
struct SourceFile {
    std::vector<Include> includes;
    std::vector<std::string> standardNames; ///< sorted, each once: "min" for std::min, "uint32_t"
};

/// Source files by path from the repository root, with '/'.
using SourceTree = std::map<std::string, SourceFile>;

/// The names after "std::" in the code of a file, and the integer types of <cstdint> with or
/// without it; comments and strings do not count.
[[nodiscard]] std::vector<std::string> readStandardNames(std::string_view text);

/// Adds the C++ files below root/folder.
void addSources(SourceTree& tree, const std::filesystem::path& root, std::string_view folder);

/// "file uses std::min without <algorithm>" for each name of a file whose header neither the file
/// nor any file of the tree that it includes, directly or not, includes. Names that are not in the
/// table are ignored.
[[nodiscard]] std::vector<std::string> findMissingHeaders(const SourceTree& tree);

} // namespace shutter::layering
