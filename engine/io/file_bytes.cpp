// SPDX-License-Identifier: MIT
#include "engine/io/file_bytes.h"

#include "engine/core/whole_file.h"

#include <OpenImageIO/hash.h>
#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <limits>
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

core::Status writeFileBytes(const fs::path& path, std::span<const uint8_t> bytes) {
    const core::Status written = core::writeWholeFile(path, std::as_bytes(bytes));
    return written
               ? written
               : core::makeError("cannot write '{}': {}", path.string(), written.error().message);
}

core::Status writeFileText(const fs::path& path, std::string_view text) {
    return writeFileBytes(path, {reinterpret_cast<const uint8_t*>(text.data()), text.size()});
}

std::string computeContentHash(std::string_view bytes) {
    const auto hash = OIIO::farmhash::Fingerprint128(bytes.data(), bytes.size());
    return fmt::format("{:016x}{:016x}", hash.first, hash.second);
}

core::Result<std::string> computeFileHash(const std::filesystem::path& path) {
    auto bytes = readFileBytes(path, std::numeric_limits<uint64_t>::max());
    if (!bytes)
        return bytes.error();
    return computeContentHash(
        {reinterpret_cast<const char*>(bytes.value().data()), bytes.value().size()}
    );
}

} // namespace shutter::io
