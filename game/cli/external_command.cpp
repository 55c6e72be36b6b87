// SPDX-License-Identifier: MIT
#include "game/cli/commands.h"
#include "game/options/program.h"

#include <CLI/CLI.hpp>

#include <cerrno>
#include <string_view>
#include <system_error>
#include <unistd.h>
#include <vector>

namespace shutter::game {

namespace fs = std::filesystem;

namespace {

struct ExternalCommand {
    const char* name;
    const char* help;
    const char* program; ///< in the folder of this program
    const char* build;   ///< makes it
};

constexpr ExternalCommand kCommands[] = {
    {"bench",
     "what accuracy costs in time",
     "shutter_bench",
     "cmake --build --preset release --target shutter_bench"},
    {"film", "draw a film in parts, by many processes", "shutter_film", "cmake --preset release"},
};

/// \param words the program's name in front and null at the end
int become(const ExternalCommand& command, std::vector<char*>& words) {
    std::error_code failure;
    const fs::path own = fs::read_symlink("/proc/self/exe", failure);
    const std::string program = (own.parent_path() / command.program).string();
    if (!fs::exists(program, failure))
        return fail(
            kExitFailed,
            core::makeError(
                "{} is a program of its own and was not built: there is no '{}'; `{}` makes it",
                command.name,
                program,
                command.build
            )
        );
    ::execv(program.c_str(), words.data());
    return fail(
        kExitFailed,
        core::makeError("cannot run '{}': {}", program, std::generic_category().message(errno))
    );
}

} // namespace

void addExternalCommands(CLI::App& app) {
    for (const ExternalCommand& command : kCommands)
        app.add_subcommand(command.name, command.help);
}

std::optional<int> runExternalCommand(int argc, char** argv) {
    std::vector<char*> words{argv[0]};
    for (int i = 1; i < argc; ++i) {
        const std::string_view word = argv[i];
        for (const ExternalCommand& command : kCommands)
            if (word == command.name) {
                words.insert(words.end(), argv + i + 1, argv + argc);
                words.push_back(nullptr);
                return become(command, words);
            }
        if (!word.starts_with('-'))
            return std::nullopt;  // another command
        words.push_back(argv[i]); // such as -v, which every program has
    }
    return std::nullopt;
}

} // namespace shutter::game
