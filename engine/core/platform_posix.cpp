// SPDX-License-Identifier: MIT
#include "engine/core/platform.h"

#include <cerrno>
#include <charconv>
#include <dlfcn.h>
#include <string>
#include <sys/stat.h>
#include <unistd.h>

namespace shutter::core {

bool isTerminal(std::FILE* stream) {
    return isatty(fileno(stream)) != 0;
}

uint64_t getProcessId() {
    return static_cast<uint64_t>(getpid());
}

std::error_code testWriting(const std::filesystem::path& path) {
    std::error_code ignored;
    const int wanted = W_OK | (std::filesystem::is_directory(path, ignored) ? X_OK : 0);
    return {access(path.c_str(), wanted) == 0 ? 0 : errno, std::generic_category()};
}

void copyOwner(const std::filesystem::path& from, const std::filesystem::path& to) {
    struct stat old {};

    if (stat(from.c_str(), &old) != 0 || chown(to.c_str(), old.st_uid, old.st_gid) == 0)
        return;
    // A user without the right to change the owner may still set one of their groups.
    [[maybe_unused]] const int ignored = chown(to.c_str(), uid_t(-1), old.st_gid);
}

std::optional<int> findOwnDescriptor(const std::filesystem::path& path) {
    const std::string name = path.filename().string();
    int descriptor = -1;
    const auto [end, failure] = std::from_chars(name.data(), name.data() + name.size(), descriptor);
    if (failure != std::errc() || end != name.data() + name.size() || descriptor < 0)
        return std::nullopt;
    std::error_code ignored;
    const auto folder = path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
    const auto own = std::filesystem::canonical("/proc/self/fd", ignored);
    if (own.empty() || std::filesystem::canonical(folder, ignored) != own)
        return std::nullopt;
    return descriptor;
}

std::FILE* openDescriptor(int descriptor) {
    const int own = dup(descriptor);
    return own < 0 ? nullptr : fdopen(own, "wb");
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
