// SPDX-License-Identifier: MIT
// Checks the header of an EXR file against the file's size: OpenEXR allocates memory for
// attributes, chunks and tiles from the header alone.
#pragma once

#include <cstdint>
#include <string>

namespace shutter::io {

/// Returns an empty string, or why the header of the file is refused: attributes that are longer
/// than the file, sides above `maxSide`, more tiles than the file has room for, many or deep
/// pictures.
[[nodiscard]] std::string
checkExrHeader(const std::string& path, uint64_t fileBytes, uint32_t maxSide);

} // namespace shutter::io
