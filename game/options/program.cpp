// SPDX-License-Identifier: MIT
#include "game/options/program.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <system_error>

namespace shutter::game {

namespace fs = std::filesystem;

std::string toOneLine(std::string text) {
    // Bytes of UTF-8 are 0x80 and above and stay.
    std::replace_if(
        text.begin(),
        text.end(),
        [](char c) {
            const auto byte = static_cast<unsigned char>(c);
            return byte < 0x20 || byte == 0x7F;
        },
        ' '
    );
    return text;
}

void printError(const core::Error& error) {
    fmt::print(stderr, "shutter: {}\n", toOneLine(error.message));
}

int fail(int status, const core::Error& error) {
    printError(error);
    return status;
}

int finishOutput(int status) {
    errno = 0;
    const bool isWritten = std::fflush(stdout) == 0 && std::ferror(stdout) == 0;
    if (isWritten)
        return status;
    const int why = errno;
    return fail(
        kExitFailed,
        core::makeError(
            "cannot write to standard output: {}",
            why != 0 ? std::generic_category().message(why) : "some of it is lost"
        )
    );
}

fs::path findCacheFolder() {
    if (const char* cache = std::getenv("XDG_CACHE_HOME"); cache && *cache)
        return fs::path(cache) / "shutter";
    if (const char* home = std::getenv("HOME"); home && *home)
        return fs::path(home) / ".cache" / "shutter";
    return {};
}

fs::path findSettingsFile() {
    const fs::path file = fs::path("shutter") / "settings.json";
    if (const char* config = std::getenv("XDG_CONFIG_HOME"); config && *config)
        return config / file;
    if (const char* home = std::getenv("HOME"); home && *home)
        return fs::path(home) / ".config" / file;
    return {};
}

fs::path findAssetFolder() {
    if (const char* named = std::getenv("SHUTTER_ASSETS"); named && *named)
        return named;
    std::error_code ignored;
    const auto program = fs::read_symlink("/proc/self/exe", ignored).parent_path();
    const auto beside = program / "assets";
    if (fs::is_directory(beside, ignored))
        return beside;
    return (program.parent_path() / "share" / "shutter" / "assets").lexically_normal();
}

} // namespace shutter::game
