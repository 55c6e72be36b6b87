// SPDX-License-Identifier: MIT
// shutter_generate_assets OUT_DIR: writes OUT_DIR/vase.glb and OUT_DIR/courtyard.glb.
// Exit status 0 done, 1 failed, 2 wrong usage.
#include "assets/generator/scenes.h"

#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <string>
#include <system_error>
#include <utility>

int main(int argc, char** argv) {
    using namespace shutter::generator;
    if (argc != 2) {
        fmt::print(stderr, "Usage: shutter_generate_assets OUT_DIR\n");
        return 2;
    }
    const std::filesystem::path folder = argv[1];
    std::error_code failure;
    std::filesystem::create_directories(folder, failure);
    if (failure) {
        fmt::print(stderr, "OUT_DIR {} cannot be made: {}.\n", folder.string(), failure.message());
        return 1;
    }
    for (const auto& [file, build] : {
             std::pair{"vase.glb", &buildVaseScene},
             std::pair{"courtyard.glb", &buildCourtyardScene},
         }) {
        const std::string error = build().write(folder / file);
        if (!error.empty()) {
            fmt::print(stderr, "{}\n", error);
            return 1;
        }
    }
    return 0;
}
