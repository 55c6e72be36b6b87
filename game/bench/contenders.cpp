// SPDX-License-Identifier: MIT
#include "game/bench/contenders.h"

#include "modules/motion_blur/settings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <vector>

namespace shutter::bench {

namespace {

/// A method of the publication with its numbers.
struct PaperRow {
    std::string_view method;
    const char* name;
    const char* description;
};

constexpr PaperRow kPaperRows[] = {
    {"gather", "gather_paper", "gather with the numbers of the publication"},
    {"hybrid", "hybrid_paper", "hybrid with the numbers of the publication"},
};

bool isPapers(std::string_view name) {
    for (const PaperRow& row : kPaperRows)
        if (name == row.name)
            return true;
    return false;
}

} // namespace

std::span<const game::MethodInfo> listContenders() {
    static const std::vector<game::MethodInfo> kContenders = [] {
        std::vector<game::MethodInfo> contenders;
        for (const game::MethodInfo& method : game::listMethods()) {
            contenders.push_back(method);
            for (const PaperRow& row : kPaperRows)
                if (method.name == row.method) {
                    contenders.push_back(method);
                    contenders.back().name = row.name;
                    contenders.back().description = row.description;
                }
        }
        return contenders;
    }();
    return kContenders;
}

core::Result<const game::MethodInfo*> findContender(std::string_view name) {
    std::vector<std::string_view> names;
    for (const game::MethodInfo& contender : listContenders()) {
        if (name == contender.name)
            return &contender;
        names.emplace_back(contender.name);
    }
    return core::makeError("method '{}' is unknown; there are {}", name, fmt::join(names, ", "));
}

game::MethodOptions makeMethodOptions(const SamplePoint& point) {
    game::MethodOptions options;
    options.method = point.method;
    options.samples = point.samples;
    if (!point.method->blur)
        return options;
    if (isPapers(point.method->name))
        options.motionBlur = motion_blur::paperSettings();
    options.motionBlur.method = point.method->blur;
    options.motionBlur.sampleCount = point.samples;
    return options;
}

} // namespace shutter::bench
