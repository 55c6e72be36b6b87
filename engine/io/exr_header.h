// SPDX-License-Identifier: MIT
// What an EXR file asks for before its first pixel, checked against its size: OpenEXR makes room
// for attributes, chunks and tiles as the header tells them.
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
