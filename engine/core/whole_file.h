// SPDX-License-Identifier: MIT
// Files that appear whole or not at all, under names that may be links: every file that a person
// asked for is written or replaced here. An Error here is a reason alone, such as "it is a folder":
// the caller names the file.
#pragma once

#include "engine/core/result.h"

#include <cstddef>
#include <filesystem>
#include <span>

namespace shutter::core {

/// What is written where a path leads. Links are followed, and stay.
struct OutputPlace {
    std::filesystem::path path; ///< not a link
    bool isStream = false; ///< a pipe, a device or an open file of this process: it is written to
                           ///< as it is, not replaced
};

/// Follows the links of a file that is there or is to be made.
/// Error: links that lead in a circle; a folder.
[[nodiscard]] Result<OutputPlace> findOutputPlace(const std::filesystem::path& path);

/// Error: writeWholeFile() cannot write there, because the folder is missing or closed to us, or
/// what is there takes nothing.
[[nodiscard]] Status checkOutput(const std::filesystem::path& path);

/// A unique name for a file that will replace `path`: in the same folder, so that this is atomic;
/// short, so that it is allowed wherever the final name is.
/// \param path not a link
[[nodiscard]] std::filesystem::path makeTemporaryPath(const std::filesystem::path& path);

/// Removes the temporary files in a folder that killed processes left, and those of running ones.
void removeTemporaryFiles(const std::filesystem::path& folder);

/// Renames `temporary` to `path`. The new file has the permissions of the one that was there, and
/// its owner and group as far as the system lets us; other hard links to the old file keep what
/// they had. Removes `temporary` where it fails. \param path not a link
[[nodiscard]] Status
replaceFile(const std::filesystem::path& temporary, const std::filesystem::path& path);

/// Writes a temporary file beside the file that `path` leads to and replaces that, so that an
/// interrupted write never leaves half a file. A stream is written to. Where it fails, nothing is
/// left behind.
[[nodiscard]] Status
writeWholeFile(const std::filesystem::path& path, std::span<const std::byte> bytes);

} // namespace shutter::core
