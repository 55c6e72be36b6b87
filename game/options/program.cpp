// SPDX-License-Identifier: MIT
#include "game/options/program.h"

#include "engine/core/log.h"
#include "engine/gpu/vulkan.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <new>
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

int runProgram(CLI::App& app, int argc, char** argv, int& exitStatus) {
    app.set_version_flag("--version", "shutter " SHUTTER_VERSION, "print the version");
    bool verbose = false;
    app.add_flag("-v,--verbose", verbose, "log what was chosen and found");
    app.parse_complete_callback([&] {
        if (verbose)
            core::setLogLevel(core::LogLevel::Info);
    });
    try {
        app.parse(argc, argv);
    } catch (const CLI::Success& success) { // --help, --version
        return finishOutput(app.exit(success));
    } catch (const CLI::ParseError& error) {
        return fail(kExitUsage, {error.what()});
    } catch (const gpu::DeviceError& error) {
        return fail(kExitFailed, {error.what()});
    } catch (const std::system_error& error) { // what printing throws where there is no room
        return fail(
            kExitFailed,
            std::ferror(stdout) != 0
                ? core::makeError("cannot write to standard output: {}", error.code().message())
                : core::Error{error.what()}
        );
    } catch (const std::bad_alloc&) {
        return fail(kExitFailed, {"out of main memory"});
    }
    return finishOutput(exitStatus);
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
    const auto inFolder = program / "assets";
    if (fs::is_directory(inFolder, ignored))
        return inFolder;
    return (program.parent_path() / "share" / "shutter" / "assets").lexically_normal();
}

} // namespace shutter::game
