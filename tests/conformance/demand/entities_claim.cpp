// SPDX-License-Identifier: MIT
#include "assets/generator/scaling_scenes.h"
#include "tests/conformance/demand/figures.h"

namespace shutter::demand {

namespace {

constexpr double kWorkRatio = 1.5;
constexpr int kMovers = 10;
constexpr int kMostEntities = generator::kMaxEntityCount;
constexpr double kStepSeconds = 1.0 / 240.0;
constexpr uint32_t kMoreRounds = 4; ///< of so cheap a figure

struct Variant {
    int count;
    bool merged; ///< what stands still is one mesh of one entity
};

constexpr Variant kVariants[] = {{kMostEntities, true}, {kMostEntities, false}};

core::Result<std::unique_ptr<Stage>>
loadVariant(const DemandOptions& options, const Variant& variant) {
    return loadScalingStage(
        options,
        fmt::format("movers-{}{}", variant.count, variant.merged ? "-merged" : ""),
        [variant] { return generator::buildFewMoversScene(variant.count, kMovers, variant.merged); }
    );
}

/// What a frame does because there are entities: extraction, entity table and top levels on the
/// CPU, and the GPU's builds of acceleration structures.
double entityWork(const render::FrameStatistics& frame) {
    double milliseconds = sumPasses(frame, [](const render::PassTime& pass) {
        return pass.owner == render::PassOwner::Rays;
    });
    for (const char* name : {"extraction ms", "entity table ms", "TLAS ms"})
        milliseconds += frame.measures.at(name);
    return milliseconds;
}

/// "extraction 0.021, entity table 0.004, ...": medians.
std::string describeParts(const Frames& frames) {
    std::string text;
    for (const char* name : {"extraction ms", "entity table ms", "TLAS ms"})
        text += fmt::format("{} {:.3g}, ", name, summarize(frames, [&](const auto& frame) {
                                                     return frame.measures.at(name);
                                                 }).median);
    const auto builds = summarize(frames, [](const render::FrameStatistics& frame) {
        return sumPasses(frame, [](const render::PassTime& pass) {
            return pass.owner == render::PassOwner::Rays;
        });
    });
    return text + fmt::format("builds ms {:.3g}", builds.median);
}

core::Result<Findings> measureEntities(gpu::Device& device, const DemandOptions& options) {
    const char* method = device.hasRays() ? "hybrid" : "gather";
    std::vector<std::unique_ptr<Stage>> stages;
    Subjects subjects;
    for (const Variant& variant : kVariants) {
        auto stage = loadVariant(options, variant);
        if (!stage)
            return stage.error();
        stages.push_back(std::move(stage).value());
        auto subject =
            Subject::create(device, *stages.back(), method, options.width, options.height);
        if (!subject)
            return subject.error();
        subject.value()->setStep(kStepSeconds);
        subjects.push_back(std::move(subject).value());
    }
    auto frames = takeTurns(subjects, options.rounds * kMoreRounds);
    if (!frames)
        return frames.error();
    const Frames& merged = frames.value().front();
    const Frames& all = frames.value().back();
    Findings findings;
    findings.times.push_back(checkMedian(
        fmt::format("{} entities, {} of which move", kMostEntities, kMovers),
        compare(all, merged, entityWork, entityWork),
        kWorkRatio,
        "of the merged scene's",
        all.size(),
        fmt::format("{}; merged: {}", describeParts(all), describeParts(merged))
    ));
    return findings;
}

} // namespace

Claim makeEntitiesClaim() {
    return {
        "Entities",
        "What stands still is not looked at",
        "Ten movers among boxes that stand still before a camera that stands still, as entities of "
        "their own against one merged mesh: extraction, tables and acceleration structures of a "
        "frame whose time goes on.",
        measureEntities};
}

} // namespace shutter::demand
