// SPDX-License-Identifier: MIT
#include "game/bench/demand/figures.h"
#include "game/bench/demand/regions.h"

namespace shutter::demand {

namespace {

constexpr double kTileShare = 0.10;

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
    auto frames = takeTurns(subjects, options.rounds);
    if (!frames)
        return frames.error();
    const Figure tiles = [](const render::FrameStatistics& frame) {
        return sumPasses(frame, isTileMax);
    };
    Findings findings;
    for (size_t i = 0; i < subjects.size(); ++i) {
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
    return findings;
}

} // namespace

Claim makeFullScreenClaim() {
    return {
        "FullScreen",
        "What the full screen costs",
        "Panels before a wall, all of which move, each row against the next: the passes that find "
        "the dominant motion against the whole effect.",
        measureFullScreen};
}

} // namespace shutter::demand
