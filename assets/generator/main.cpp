// SPDX-License-Identifier: MIT
// shutter_generate_assets [--all] OUT_DIR: writes OUT_DIR/vase.glb, OUT_DIR/courtyard.glb and those
// of the gameplay demos; with --all also OUT_DIR/NAME.glb for each of the hard cases and those of
// particles.
// Exit status 0 done, 1 failed, 2 wrong usage.
#include "assets/generator/demo_scenes.h"
#include "assets/generator/hard_cases.h"
#include "assets/generator/scenes.h"

#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

namespace {

using namespace shutter::generator;

struct Output {
    std::string name;
    GltfWriter (*build)();
};

std::vector<Output> listOutputs(bool all) {
    std::vector<Output> outputs = {
        {"vase", &buildVaseScene},
        {"courtyard", &buildCourtyardScene},
        {"rally", &buildRallyScene},
        {"gallery", &buildGalleryScene},
        {"spin", &buildSpinScene}};
    if (all) {
        for (const BenchCase& hardCase : listHardCases()) {
            outputs.push_back({hardCase.name, hardCase.build});
        }
    }
    return outputs;
}

} // namespace

int main(int argc, char** argv) {
    const bool all = argc == 3 && std::string_view(argv[1]) == "--all";
    const std::string_view last = argc > 1 ? argv[argc - 1] : "";
    if (argc != (all ? 3 : 2) || last.empty() || last.starts_with("-")) {
        fmt::print(stderr, "Usage: shutter_generate_assets [--all] OUT_DIR\n");
        return 2;
    }
    const std::filesystem::path folder = last;
    std::error_code failure;
    std::filesystem::create_directories(folder, failure);
    if (failure) {
        fmt::print(stderr, "OUT_DIR {} cannot be made: {}.\n", folder.string(), failure.message());
        return 1;
    }
    for (const Output& output : listOutputs(all)) {
        const std::string error = output.build().write(folder / (output.name + ".glb"));
        if (!error.empty()) {
            fmt::print(stderr, "{}\n", error);
            return 1;
        }
    }
    return 0;
}
