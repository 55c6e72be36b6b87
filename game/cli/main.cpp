// SPDX-License-Identifier: MIT
#include "game/cli/commands.h"
#include "game/cli/external_command.h"
#include "game/options/program.h"
#include "game/play/loop/play_options.h"
#include "game/replay/replay_command.h"

#include <CLI/CLI.hpp>

using namespace shutter;

int main(int argc, char** argv) {
    if (const auto exitStatus = game::runExternalCommand(argc, argv))
        return *exitStatus;
    CLI::App app("Shutter: motion blur that is right", "shutter");
    app.require_subcommand(1);
    app.set_version_flag("--version", "shutter " SHUTTER_VERSION, "print the version");
    bool verbose = false;
    app.add_flag("-v,--verbose", verbose, "log what was chosen and found");
    app.parse_complete_callback([&] {
        if (verbose)
            core::setLogLevel(core::LogLevel::Info);
    });
    int exitStatus = game::kExitDone;
    game::addRenderCommand(app, exitStatus);
    game::addCompareCommand(app, exitStatus);
    game::addInfoCommand(app, exitStatus);
    game::addPlayCommand(app, exitStatus);
    replay::addReplayCommand(app, exitStatus);
    try {
        app.parse(argc, argv);
    } catch (const CLI::Success& success) { // --help, --version
        return game::finishOutput(app.exit(success));
    } catch (const CLI::ParseError& error) {
        game::printError({error.what()});
        return game::kExitUsage;
    } catch (const gpu::DeviceError& error) {
        game::printError({error.what()});
        return game::kExitFailed;
    } catch (const std::system_error& error) { // what printing throws where there is no room
        return game::fail(
            game::kExitFailed,
            std::ferror(stdout) != 0
                ? core::makeError("cannot write to standard output: {}", error.code().message())
                : core::Error{error.what()}
        );
    } catch (const std::bad_alloc&) {
        game::printError({"out of main memory"});
        return game::kExitFailed;
    }
    return game::finishOutput(exitStatus);
}
