// SPDX-License-Identifier: MIT
#include "engine/core/platform.h"

#include <dlfcn.h>
#include <unistd.h>

namespace shutter::core {

bool isTerminal(std::FILE* stream) {
    return isatty(fileno(stream)) != 0;
}

uint64_t getProcessId() {
    return static_cast<uint64_t>(getpid());
}

Result<void*> openLibrary(const char* name) {
    void* const library = dlopen(name, RTLD_NOW | RTLD_LOCAL);
    if (!library)
        return Error{dlerror()};
    return library;
}

FoundFunction findFunction(void* library, const char* name) {
    return reinterpret_cast<FoundFunction>(dlsym(library, name));
}

} // namespace shutter::core
