// SPDX-License-Identifier: MIT
#include "game/options/program.h"

#include "engine/core/log.h"
#include "engine/core/setting_row.h"
#include "engine/core/words.h"
#include "engine/gpu/vulkan.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <new>
#include <string_view>
#include <system_error>
#include <vector>

namespace shutter::game {

namespace fs = std::filesystem;

namespace {

bool isOption(const std::string& word) {
    return word.size() > 1 && word[0] == '-' &&
           !std::isdigit(static_cast<unsigned char>(word[1])) && word[1] != '.';
}

/// "'rendr' is no command (did you mean render?); there are render, ...", of a program of commands.
/// \param unknown words of the command line in place of a command
std::string explainCommand(const CLI::App& app, const std::vector<std::string>& unknown) {
    std::vector<std::string> names;
    for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
        names.push_back(command->get_name());
    const std::string all = fmt::format("{}", fmt::join(names, ", "));
    if (unknown.empty())
        return "no command is given; there are " + all;
    if (isOption(unknown.front()))
        return fmt::format("no command comes before {}; there are {}", unknown.front(), all);
    const std::string nearest = core::findNearest(unknown.front(), names);
    return fmt::format(
        "'{}' is no command{}; there are {}",
        unknown.front(),
        nearest.empty() ? "" : fmt::format(" (did you mean {}?)", nearest),
        all
    );
}

/// "'--otu' is no option of render; did you mean --out?"
std::string
explainOption(const CLI::App& command, const std::string& name, const std::string& typed) {
    std::vector<std::string> names;
    for (const CLI::Option* option : command.get_options())
        names.insert(names.end(), option->get_lnames().begin(), option->get_lnames().end());
    const std::string nearest = core::findNearest(
        typed.substr(std::min(typed.find_first_not_of('-'), typed.size())), names
    );
    return fmt::format(
        "'{}' is no option of {}; {}",
        typed,
        name,
        nearest.empty() ? fmt::format("`shutter {} --help` lists them", name)
                        : fmt::format("did you mean --{}?", nearest)
    );
}

/// What is wrong with the values of an option; empty: nothing.
std::string explainValues(const CLI::Option& option) {
    const std::string kind = option.get_type_name();
    const bool isWhole = kind.starts_with("UINT") || kind.starts_with("INT");
    if (!isWhole && !kind.starts_with("FLOAT"))
        return {};
    for (const std::string& value : option.results()) {
        const auto number = core::parseNumber(value);
        if (!number)
            return fmt::format("{}: '{}' is not a number", option.get_name(), value);
        if (isWhole && (*number != std::floor(*number) || *number < 0.0))
            return fmt::format("{}: {} is not a whole number from 0 on", option.get_name(), value);
    }
    return {};
}

/// The parser's error, its frequent kinds worded as our own refusals are.
std::string reword(const CLI::ParseError& error) {
    const std::string text = error.what();
    const size_t colon = std::min(text.find(": "), text.size());
    if (error.get_name() == "ArgumentMismatch" && text.ends_with(" missing"))
        return text.substr(0, colon) + " needs a value";
    // "--frames: Value 0 not in range 1 to 9"
    constexpr std::string_view kOutside = " not in range ";
    constexpr std::string_view kValue = ": Value ";
    const size_t outside = text.find(kOutside);
    if (outside != std::string::npos && text.substr(colon).starts_with(kValue)) {
        const size_t value = colon + kValue.size();
        return fmt::format(
            "{}: {} must be {}",
            text.substr(0, colon),
            text.substr(value, outside - value),
            text.substr(outside + kOutside.size())
        );
    }
    // "Could not convert: --samples = 99999999999"
    constexpr std::string_view kEquals = " = ";
    const size_t equals = text.find(kEquals);
    if (error.get_name() == "ConversionError" && equals != std::string::npos && colon < equals) {
        const std::string option = text.substr(colon + 2, equals - colon - 2);
        const std::string value = text.substr(equals + kEquals.size());
        return core::parseNumber(value) ? fmt::format("{}: {} is too large", option, value)
                                        : fmt::format("{} does not take '{}'", option, value);
    }
    return text;
}

/// The command line's error in one sentence. A misspelt word counts first: others may follow from
/// it.
std::string explain(const CLI::App& app, const CLI::ParseError& error) {
    const std::vector<CLI::App*> chosen = app.get_subcommands();
    const bool hasCommands = !app.get_subcommands([](const CLI::App*) { return true; }).empty();
    const std::vector<std::string> before = app.remaining();
    if (hasCommands && chosen.empty())
        return explainCommand(app, before);
    const CLI::App& command = hasCommands ? *chosen.front() : app;
    // "shutter bench" is a program of its own.
    const std::string name = command.get_name().substr(command.get_name().find(' ') + 1);
    if (hasCommands && !before.empty() && !isOption(before.front()))
        return explainCommand(app, before);
    for (const std::string& word : app.remaining(true)) {
        if (!isOption(word))
            continue;
        const std::string option = word.substr(0, word.find('='));
        if (command.get_option_no_throw(option))
            return fmt::format("{} must come after the command {}", option, name);
        if (hasCommands && app.get_option_no_throw(option))
            return fmt::format("{} must come before the command {}", option, name);
        return explainOption(command, name, option);
    }
    const std::vector<std::string> unknown = command.remaining();
    if (!unknown.empty())
        return fmt::format("'{}' is one argument too many for {}", unknown.front(), name);
    for (const CLI::Option* option : command.get_options()) {
        const auto given = static_cast<int>(option->count());
        if (option->get_items_expected_max() == 1 && given > 1)
            return fmt::format("{} is given {} times", option->get_name(), given);
        if (std::string wrong = explainValues(*option); !wrong.empty())
            return wrong;
    }
    return reword(error);
}

} // namespace

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
        return fail(kExitUsage, {explain(app, error)});
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
