// SPDX-License-Identifier: MIT
// What the program reads and writes, for tests of it in Python.
//   flythroughs FILE...   prints a line for each: empty, or why it is refused
//   settings FILE...      the same for the player's settings
//   write FOLDER COUNT    writes that many files of random valid settings
//   page FOLDER           writes the report page of FOLDER/results.json; the tests skip where none
//                         can be made
#include "engine/flythrough/flythrough.h"
#include "game/bench/report/report_page.h"
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

int makePage(const char* folder) {
    const core::Status possible = bench::checkReportPageCanBeMade();
    const core::Status made = possible ? bench::remakeReportPage(folder) : possible;
    if (!made)
        fmt::print(stderr, "{}\n", made.error().message);
    return possible ? (made ? 0 : 1) : 77;
}

} // namespace

int main(int argc, char** argv) {
    const std::string_view command = argc > 1 ? argv[1] : "";
    if (command == "flythroughs")
        return printErrors(argc - 2, argv + 2, flythrough::readFlythrough);
    if (command == "settings")
        return printErrors(argc - 2, argv + 2, game::loadPlaySettings);
    if (command == "page" && argc == 3)
        return makePage(argv[2]);
    if (command == "write" && argc == 4)
        return writeFiles(argv[2], static_cast<uint32_t>(std::atoi(argv[3])));
    return 2;
}
