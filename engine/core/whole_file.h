// SPDX-License-Identifier: MIT
// Files that appear whole or not at all, under names that may be links: all requested output files
// are written or replaced through these functions. An Error is only the reason, such as "it is a
// folder"; the caller names the file.
#pragma once

#include "engine/core/result.h"

#include <cstddef>
#include <filesystem>
#include <span>

namespace shutter::core {

/// The target of an output path. Links are followed and preserved.
struct OutputPlace {
    std::filesystem::path path; ///< not a link
    bool isStream = false; ///< a pipe, a device or an open file of this process: it is written to
                           ///< as it is, not replaced
};

/// Follows the links of an existing or future file.
/// Error: links that lead in a circle; a folder.
[[nodiscard]] Result<OutputPlace> findOutputPlace(const std::filesystem::path& path);

/// Error: writeWholeFile() cannot write there, because the folder is missing or not writable, or
/// the existing file cannot be written.
[[nodiscard]] Status checkOutput(const std::filesystem::path& path);

/// A unique name for a file that will replace `path`: in the same folder, so that this is atomic;
/// short, so that it is allowed wherever the final name is.
/// \param path not a link
[[nodiscard]] std::filesystem::path makeTemporaryPath(const std::filesystem::path& path);

/// Removes the temporary files in a folder that killed processes left, and those of running ones.
void removeTemporaryFiles(const std::filesystem::path& folder);

/// Renames `temporary` to `path`. The new file has the permissions of the one that was there, and
/// its owner and group where the system permits; other hard links to the old file keep the old
/// contents. Removes `temporary` on failure. \param path not a link
[[nodiscard]] Status
replaceFile(const std::filesystem::path& temporary, const std::filesystem::path& path);

/// Writes a temporary file in the folder of the file that `path` leads to and then replaces that
/// file, so that an interrupted write never leaves half a file. Streams are written directly. On
/// failure nothing is left behind.
[[nodiscard]] Status
writeWholeFile(const std::filesystem::path& path, std::span<const std::byte> bytes);

} // namespace shutter::core
