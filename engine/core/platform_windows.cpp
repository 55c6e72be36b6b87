// SPDX-License-Identifier: MIT
#include "engine/core/platform.h"

#include <io.h>
#include <system_error>
#include <windows.h>

namespace shutter::core {

bool isTerminal(std::FILE* stream) {
    return _isatty(_fileno(stream)) != 0;
}

uint64_t getProcessId() {
    return GetCurrentProcessId();
}

std::error_code testWriting(const std::filesystem::path& path) {
    constexpr int kWrite = 2;
    const bool mayWrite = _waccess(path.c_str(), kWrite) == 0;
    return mayWrite ? std::error_code() : std::make_error_code(std::errc::permission_denied);
}

void copyOwner(const std::filesystem::path& /*from*/, const std::filesystem::path& /*to*/) {
    // A file inherits access from its folder.
}

std::optional<int> findOwnDescriptor(const std::filesystem::path& /*path*/) {
    return std::nullopt; // descriptors have no paths
}

std::FILE* openDescriptor(int descriptor) {
    const int own = _dup(descriptor);
    return own < 0 ? nullptr : _fdopen(own, "wb");
}

Result<void*> openLibrary(const char* name) {
    const HMODULE library = LoadLibraryA(name);
    if (!library) {
        const std::error_code reason(static_cast<int>(GetLastError()), std::system_category());
        return makeError("{}: {}", name, reason.message());
    }
    return static_cast<void*>(library);
}

FoundFunction findFunction(void* library, const char* name) {
    return reinterpret_cast<FoundFunction>(GetProcAddress(static_cast<HMODULE>(library), name));
}

} // namespace shutter::core
