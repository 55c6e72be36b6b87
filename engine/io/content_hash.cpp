// SPDX-License-Identifier: MIT
#include "engine/io/content_hash.h"

#include "engine/io/file_bytes.h"

#include <OpenImageIO/hash.h>
#include <fmt/format.h>

#include <limits>

namespace shutter::io {

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
