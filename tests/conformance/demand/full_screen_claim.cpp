// SPDX-License-Identifier: MIT
#include "tests/conformance/demand/figures.h"
#include "tests/conformance/demand/floor_effect.h"
#include "tests/conformance/demand/regions.h"

namespace shutter::demand {

namespace {

constexpr double kTileShare = 0.10;
constexpr double kOfTheFloor = 1.5;

/// GPU milliseconds of the passes of one name.
Figure timeOf(std::string_view name) {
    return [name](const render::FrameStatistics& frame) {
        return sumPasses(frame, [name](const render::PassTime& pass) { return pass.name == name; });
    };
}

stability::Measured checkFloor(const Frames& gather, const Frames& floor) {
    return checkMedian(
        "gather: the filter itself",
        compare(gather, floor, timeOf("gather"), timeOf("gather floor")),
        kOfTheFloor,
        "of its fetches alone",
        gather.size(),
        fmt::format(
            "{:.4g} against {:.4g} ms",
            summarize(gather, timeOf("gather")).median,
            summarize(floor, timeOf("gather floor")).median
        )
    );
}

/// Without this, a filter with nothing to do would be as fast as its floor.
stability::Measured checkFullPath(const Frames& gather) {
    const auto& counters = gather.back().counters;
    const auto count = [&](const char* name) { return double(counters.at(name)); };
    const double all = count("blocks still") + count("blocks uniform") + count("blocks mixed") +
                       count("blocks masked");
    return {
        "gather: blocks without the full filter",
        1.0 - count("blocks mixed") / all,
        0.1,
        "of the picture's",
        gather.size()};
}

core::Result<Findings> measureFullScreen(gpu::Device& device, const DemandOptions& options) {
    auto stage = loadFullScreen(options);
    if (!stage)
        return stage.error();
    Subjects subjects;
    for (const char* name : {"gather", "hybrid"}) {
        if (!game::canRun(*game::findMethod(name).value(), device))
            continue;
        auto subject = Subject::create(device, *stage.value(), name, options.width, options.height);
        if (!subject)
            return subject.error();
        subjects.push_back(std::move(subject).value());
    }
    auto floor = Subject::createWithEffect(
        device,
        *stage.value(),
        std::make_unique<FloorEffect>(device, motion_blur::MotionBlurSettings{}),
        options.width,
        options.height
    );
    if (!floor)
        return floor.error();
    const size_t methodCount = subjects.size();
    subjects.push_back(std::move(floor).value());
    auto frames = takeTurns(subjects, options.rounds);
    if (!frames)
        return frames.error();
    const Figure tiles = [](const render::FrameStatistics& frame) {
        return sumPasses(frame, isTileMax);
    };
    Findings findings;
    for (size_t i = 0; i < methodCount; ++i) {
        const game::MethodInfo& method = subjects[i]->method();
        const Frames& own = frames.value()[i];
        findings.checks.push_back(checkMedian(
            fmt::format("{}: tile max and neighbour max", method.name),
            compare(own, own, tiles, effectOf(method)),
            kTileShare,
            "of the effect",
            own.size(),
            fmt::format(
                "{:.4g} of {:.4g} ms",
                summarize(own, tiles).median,
                summarize(own, effectOf(method)).median
            )
        ));
    }
    findings.checks.push_back(checkFloor(frames.value().front(), frames.value().back()));
    findings.checks.push_back(checkFullPath(frames.value().front()));
    return findings;
}

} // namespace

Claim makeFullScreenClaim() {
    return {
        "FullScreen",
        "What the full screen costs",
        "Panels before a wall, all of which move, each row against the next: the passes that find "
        "the dominant motion against the whole effect, and the filter against a kernel that only "
        "fetches and averages the same taps.",
        measureFullScreen};
}

} // namespace shutter::demand
