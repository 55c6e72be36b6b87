// SPDX-License-Identifier: MIT
// What the program reads and writes, for the tests that hold it against the schemas.
//   flythroughs FILE...   prints a line for each: empty, or why it is refused
//   settings FILE...      the same for the player's settings
//   write FOLDER COUNT    writes that many files of random valid settings
#include "engine/flythrough/flythrough.h"
#include "game/play/panel/play_settings.h"
#include "tests/unit/panel/random_settings.h"

#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <string_view>

using namespace shutter;

namespace {

int writeFiles(const std::filesystem::path& folder, uint32_t count) {
    for (uint32_t seed = 0; seed < count; ++seed) {
        const auto file = folder / fmt::format("{}.json", seed);
        const core::Status saved = game::savePlaySettings(file, test::RandomSettings(seed).make());
        if (!saved) {
            fmt::print(stderr, "{}\n", saved.error().message);
            return 1;
        }
    }
    return 0;
}

template <class Read> int printErrors(int count, char** files, const Read& read) {
    for (int i = 0; i < count; ++i) {
        const auto content = read(files[i]);
        fmt::print("{}\n", content ? "" : content.error().message);
    }
    return 0;
}

} // namespace

int main(int argc, char** argv) {
    const std::string_view command = argc > 1 ? argv[1] : "";
    if (command == "flythroughs")
        return printErrors(argc - 2, argv + 2, flythrough::readFlythrough);
    if (command == "settings")
        return printErrors(argc - 2, argv + 2, game::loadPlaySettings);
    if (command == "write" && argc == 4)
        return writeFiles(argv[2], static_cast<uint32_t>(std::atoi(argv[3])));
    return 2;
}
