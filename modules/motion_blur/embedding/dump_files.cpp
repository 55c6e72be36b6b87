// SPDX-License-Identifier: MIT
#include "modules/motion_blur/embedding/dump_files.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <system_error>

namespace shutter::motion_blur {

core::Status writeDumpFile(const std::filesystem::path& path, std::span<const std::byte> bytes) {
    std::filesystem::path temporary = path;
    temporary += ".part";
    const auto fail = [&](int reason) {
        std::error_code ignored;
        std::filesystem::remove(temporary, ignored);
        return core::makeError("'{}': {}", path.string(), std::strerror(reason));
    };
    std::FILE* file = std::fopen(temporary.string().c_str(), "wb");
    if (!file)
        return fail(errno);
    const bool isWritten = std::fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size();
    const int writeError = errno;
    const bool isClosed = std::fclose(file) == 0;
    if (!isWritten || !isClosed)
        return fail(isWritten ? errno : writeError);
    std::error_code error;
    std::filesystem::rename(temporary, path, error);
    return error ? fail(error.value()) : core::Status();
}

} // namespace shutter::motion_blur
