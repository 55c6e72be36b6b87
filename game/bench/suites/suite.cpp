// SPDX-License-Identifier: MIT
#include "game/bench/suites/suite.h"

#include <algorithm>
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
    SuiteRow{"stability", makeStabilitySuite},
    SuiteRow{"demand", makeDemandSuite},
};

std::vector<uint32_t> listPowersOfTwo(uint32_t first, uint32_t last) {
    std::vector<uint32_t> powers;
    for (uint32_t power = first; power <= last; power *= 2)
        powers.push_back(power);
    return powers;
}

/// Sample counts to measure a method at, rising; its default is one of them if it is not above
/// them.
std::vector<uint32_t> listSampleCounts(const game::MethodInfo& method, uint32_t maxRays) {
    if (!method.sampleUnit)
        return {0};
    std::vector<uint32_t> counts;
    switch (*method.sampleUnit) {
    case game::SampleUnit::Taps:
        counts = listPowersOfTwo(4, 64);
        break;
    case game::SampleUnit::Instants:
        counts = listPowersOfTwo(2, 64); // the default of one is the truth itself
        break;
    case game::SampleUnit::Rays:
        counts = listPowersOfTwo(1, maxRays);
        break;
    }
    if (method.defaultSamples < counts.back())
        counts.push_back(method.defaultSamples);
    std::sort(counts.begin(), counts.end());
    counts.erase(std::unique(counts.begin(), counts.end()), counts.end());
    return counts;
}

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

std::vector<SamplePoint>
makeSweep(const std::vector<const game::MethodInfo*>& methods, uint32_t maxRays) {
    std::vector<SamplePoint> points;
    for (const game::MethodInfo* method : methods)
        for (uint32_t count : listSampleCounts(*method, maxRays))
            points.push_back({method, count, count == method->defaultSamples});
    return points;
}

std::vector<SamplePoint> makeScalingPoints(const std::vector<const game::MethodInfo*>& methods) {
    constexpr uint32_t kMostSamples = 4;
    std::vector<SamplePoint> points;
    for (const game::MethodInfo* method : methods) {
        const bool isTruth = method->family == game::MethodFamily::Accumulate ||
                             method->family == game::MethodFamily::Truth;
        points.push_back({method, isTruth ? kMostSamples : method->defaultSamples, !isTruth});
    }
    return points;
}

} // namespace shutter::bench
