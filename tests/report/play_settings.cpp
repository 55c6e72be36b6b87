// SPDX-License-Identifier: MIT
// Settings files for the test that holds them against their schema.
//   write FOLDER COUNT   writes that many files of random valid settings
//   check FILE...        prints of each file "ok", or why it is refused
#include "game/play/panel/play_settings.h"

#include "tests/unit/panel/random_settings.h"

#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <string_view>
#include <vector>

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

int checkFile(const char* file) {
    const auto settings = game::loadPlaySettings(file);
    fmt::print("{}\n", settings ? "ok" : settings.error().message);
    return 0;
}

} // namespace

int main(int argc, char** argv) {
    const std::vector<const char*> arguments(argv + 1, argv + argc);
    if (arguments.size() == 3 && arguments[0] == std::string_view("write"))
        return writeFiles(arguments[1], static_cast<uint32_t>(std::atoi(arguments[2])));
    if (arguments.size() < 2 || arguments[0] != std::string_view("check"))
        return 2;
    for (size_t i = 1; i < arguments.size(); ++i)
        checkFile(arguments[i]);
    return 0;
}
