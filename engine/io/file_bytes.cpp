// SPDX-License-Identifier: MIT
#include "engine/io/file_bytes.h"

#include <algorithm>
#include <fstream>
#include <system_error>

namespace shutter::io {

namespace fs = std::filesystem;

core::Result<std::vector<uint8_t>> readFileBytes(const fs::path& path, uint64_t maxBytes) {
    std::error_code failure;
    const fs::file_status status = fs::status(path, failure);
    if (status.type() == fs::file_type::not_found) {
        return core::makeError("cannot open '{}': no such file", path.string());
    }
    if (failure)
        return core::makeError("cannot open '{}': {}", path.string(), failure.message());
    if (fs::is_directory(status)) {
        return core::makeError("cannot open '{}': it is a folder", path.string());
    }
    // A pipe or a device could block for ever or never end.
    if (!fs::is_regular_file(status)) {
        return core::makeError("cannot open '{}': it is not a regular file", path.string());
    }
    const uint64_t size = fs::file_size(path, failure);
    if (failure)
        return core::makeError("cannot open '{}': {}", path.string(), failure.message());
    std::ifstream stream(path, std::ios::binary);
    if (!stream)
        return core::makeError("cannot open '{}': permission denied", path.string());
    std::vector<uint8_t> bytes(std::min(size, maxBytes));
    stream.read(reinterpret_cast<char*>(bytes.data()), std::streamsize(bytes.size()));
    if (uint64_t(stream.gcount()) != bytes.size()) {
        return core::makeError("cannot read '{}': it ended early", path.string());
    }
    return bytes;
}

} // namespace shutter::io
