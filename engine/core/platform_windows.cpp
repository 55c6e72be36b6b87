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
