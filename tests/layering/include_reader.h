// SPDX-License-Identifier: MIT
// Finds the #include lines of C++ and GLSL.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace shutter::layering {

/// One #include line.
struct Include {
    std::string file;    ///< the including file, from the repository root, with '/'
    size_t line = 0;     ///< from 1
    std::string target;  ///< the text between the quotes or brackets; empty for a macro
    bool quoted = false; ///< "target" rather than <target>
};

/// The text with every comment turned into spaces; line ends and string contents stay.
[[nodiscard]] std::string blankComments(std::string_view text);

/// The includes of one file's text, in order. Lines inside comments do not count; lines that the
/// preprocessor would skip do, so that a dependence cannot hide behind an #if.
[[nodiscard]] std::vector<Include> readIncludes(std::string_view file, std::string_view text);

/// The includes of every source file below root/folder, sorted by file; none if there is no such
/// folder. Read-me and CMake files are not sources.
[[nodiscard]] std::vector<Include>
collectIncludes(const std::filesystem::path& root, std::string_view folder);

} // namespace shutter::layering
