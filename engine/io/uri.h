// SPDX-License-Identifier: MIT
// URIs of glTF buffers and images: data URIs, and relative paths that stay inside one folder.
#pragma once

#include "engine/core/result.h"

#include <cstdint>
#include <filesystem>
#include <string_view>
#include <vector>

namespace shutter::io {

/// Whether it begins with `data:`, in any case; what follows need not be valid.
[[nodiscard]] bool isDataUri(std::string_view uri);

/// Bytes of a data URI (RFC 2397), base64 (the URL-safe alphabet as well, padding may lack) or
/// percent-encoded; the media type is ignored. Error: names the malformed part.
[[nodiscard]] core::Result<std::vector<uint8_t>> decodeDataUri(std::string_view uri);

/// Which files a file may name.
enum class Reach : uint8_t {
    Folder,   ///< those in the file's folder and below
    Anywhere, ///< all files, at the reader's request
};

/// The file that a relative URI names below `folder` (empty: the working folder). `.` and `..` are
/// resolved in the text, as in RFC 3986: a folder that `..` leaves again need not exist, and is not
/// followed if it is a link. Refuses, without touching the disk first: nothing at all, schemes
/// (http:, file:, C:), absolute paths, more `..` than names before them, `..\`, NUL, broken
/// percent-encoding, over 4096 bytes; then links that lead out of the folder. With Reach::Anywhere,
/// absolute paths, any `..` and such links are taken. The file itself need not exist. Error: the
/// fault of the URI.
[[nodiscard]] core::Result<std::filesystem::path>
resolveUri(const std::filesystem::path& folder, std::string_view uri, Reach reach = Reach::Folder);

/// Whether `path`, from `folder` on unless it is absolute, lies in `folder` (empty: the working
/// folder) or below, links and `..` followed. It need not exist.
[[nodiscard]] bool
liesInside(const std::filesystem::path& folder, const std::filesystem::path& path);

/// A URI for use in a message: its first 80 bytes and "..." where it is longer.
[[nodiscard]] std::string abbreviateUri(std::string_view uri);

} // namespace shutter::io
