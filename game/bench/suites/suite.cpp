// SPDX-License-Identifier: MIT
#include "game/bench/suites/suite.h"

#include <array>

namespace shutter::bench {

namespace {

struct SuiteRow {
    std::string_view name;
    Suite (*make)();
};

constexpr std::array kSuites = {
    SuiteRow{"paper", makePaperSuite},
    SuiteRow{"hard", makeHardSuite},
    SuiteRow{"scaling", makeScalingSuite},
    SuiteRow{"sequence", makeSequenceSuite},
};

} // namespace

std::function<core::Status(const std::filesystem::path&)>
makeWriter(std::function<generator::GltfWriter()> build) {
    return [build = std::move(build)](const std::filesystem::path& file) -> core::Status {
        if (const std::string error = build().write(file); !error.empty())
            return core::Error{error};
        return {};
    };
}

core::Result<Suite> findSuite(std::string_view name) {
    std::string names;
    for (const SuiteRow& row : kSuites) {
        if (row.name == name)
            return row.make();
        names += fmt::format("{}{}", names.empty() ? "" : ", ", row.name);
    }
    return core::makeError("--suite '{}' is not one of {}", name, names);
}

Suite makeOwnSuite(const game::ShotArguments& shot) {
    Suite suite;
    suite.name = "own";
    Case own;
    own.name = "own";
    own.title = std::filesystem::path(shot.scene).filename().string();
    own.description = "A scene given on the command line.";
    own.shot = shot;
    suite.cases = {own};
    return suite;
}

} // namespace shutter::bench
