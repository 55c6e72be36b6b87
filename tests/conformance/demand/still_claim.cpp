// SPDX-License-Identifier: MIT
#include "assets/generator/scaling_scenes.h"
#include "assets/generator/scenes.h"
#include "tests/conformance/demand/figures.h"
#include "tests/conformance/stability/pictures.h"

#include <algorithm>
#include <cmath>

namespace shutter::demand {

namespace {

constexpr double kFrameRatio = 1.01;
/// What the module adds weighs most in a small frame, and many of them tell a hundredth apart.
constexpr uint32_t kSmaller = 4;
constexpr uint32_t kMoreRounds = 20;

struct StillScene {
    const char* name;
    const char* why; ///< it stands still
    generator::GltfWriter (*build)();
    double exposureSeconds;
};

const StillScene kScenes[] = {
    {"vase-unexposed", "no exposure", &generator::buildVaseScene, 0.0},
    {"panels-still",
     "no movement",
     [] { return generator::buildMovingRegionScene(0, 0); },
     generator::kScalingExposureSeconds},
};

core::Result<Subjects>
makePair(gpu::Device& device, const Stage& stage, uint32_t width, uint32_t height) {
    Subjects subjects;
    for (const char* method : {"sharp", "hybrid"}) {
        auto subject = Subject::create(device, stage, method, width, height);
        if (!subject)
            return subject.error();
        subjects.push_back(std::move(subject).value());
    }
    return subjects;
}

uint64_t countValuesThatDiffer(const image::Image& a, const image::Image& b) {
    if (a.pixels.size() != b.pixels.size())
        return std::max(a.pixels.size(), b.pixels.size());
    uint64_t count = 0;
    for (size_t i = 0; i < a.pixels.size(); ++i)
        count += !(a.pixels[i] == b.pixels[i]);
    return count;
}

/// What the frame is made of.
core::Status addParts(
    Findings& findings,
    gpu::Device& device,
    const Stage& stage,
    const DemandOptions& options,
    const std::string& why
) {
    const uint32_t levelsBefore = device.living().accelerationStructures;
    auto subjects = makePair(device, stage, options.width, options.height);
    if (!subjects)
        return subjects.error();
    std::vector<render::FrameResult> drawn;
    for (const auto& subject : subjects.value()) {
        subject->setDump(true);
        auto frame = subject->draw();
        if (!frame)
            return frame.error();
        drawn.push_back(std::move(frame).value());
    }
    const GraphParts sharp = readDump(drawn[0].dump);
    const GraphParts hybrid = readDump(drawn[1].dump);
    const auto add = [&](const char* check, uint64_t found, const char* unit, uint64_t samples) {
        findings.checks.push_back(
            {fmt::format("{}: {}", why, check), double(found), 0.0, unit, samples}
        );
    };
    add("passes beyond sharp's", countBeyond(hybrid.passes, sharp.passes), "", hybrid.passes.size()
    );
    add("images beyond sharp's", countBeyond(hybrid.images, sharp.images), "", hybrid.images.size()
    );
    add("buffers beyond sharp's",
        countBeyond(hybrid.buffers, sharp.buffers),
        "",
        hybrid.passes.size());
    const uint64_t most =
        std::max(drawn[0].statistics.transientBytes, drawn[1].statistics.transientBytes);
    const uint64_t least =
        std::min(drawn[0].statistics.transientBytes, drawn[1].statistics.transientBytes);
    add("memory that differs from sharp's", most - least, "bytes", most);
    const uint32_t levels = device.living().accelerationStructures;
    add("acceleration structures made",
        levels - std::min(levels, levelsBefore), // earlier ones may have gone meanwhile
        "",
        hybrid.passes.size());
    add("values that differ from sharp's",
        countValuesThatDiffer(drawn[0].display, drawn[1].display),
        "",
        drawn[1].display.pixels.size());
    return {};
}

core::Status addTime(
    Findings& findings,
    gpu::Device& device,
    const Stage& stage,
    const DemandOptions& options,
    const std::string& why
) {
    const uint32_t width = std::max(options.width / kSmaller, 1u);
    const uint32_t height = std::max(options.height / kSmaller, 1u);
    auto subjects = makePair(device, stage, width, height);
    if (!subjects)
        return subjects.error();
    auto frames = takeTurns(subjects.value(), options.rounds * kMoreRounds);
    if (!frames)
        return frames.error();
    // On a software device the frame is the processors' work, whoever else uses them.
    const bool isSoftware = device.info().kind == "software";
    const Figure time = [isSoftware](const render::FrameStatistics& frame) {
        return isSoftware ? frame.measures.at(kProcessMilliseconds) : frame.wallMilliseconds;
    };
    const Frames& sharp = frames.value()[0];
    const Frames& hybrid = frames.value()[1];
    findings.checks.push_back(checkMedian(
        why + ": time of the frame",
        compare(hybrid, sharp, time, time),
        kFrameRatio,
        "of sharp's",
        hybrid.size(),
        fmt::format(
            "{:.4g} against {:.4g} ms {} at {}x{}",
            summarize(hybrid, time).median,
            summarize(sharp, time).median,
            isSoftware ? "of processors" : "on the wall's clock",
            width,
            height
        )
    ));
    return {};
}

core::Result<Findings> measureStill(gpu::Device& device, const DemandOptions& options) {
    if (!device.hasRays())
        return core::makeError("{} traces no rays", device.info().name);
    Findings findings;
    for (const StillScene& scene : kScenes) {
        game::ShotArguments arguments;
        arguments.camera = "main";
        arguments.shutter.shutter.exposureSeconds = scene.exposureSeconds;
        auto stage = loadStage(options, scene.name, scene.build, std::move(arguments));
        if (!stage)
            return stage.error();
        for (const auto add : {addParts, addTime})
            SHUTTER_TRY(add(findings, device, *stage.value(), options, scene.why));
    }
    return findings;
}

} // namespace

Claim makeStillClaim() {
    return {
        "Still",
        "Stillness costs nothing",
        "Frames of hybrid against frames of sharp where nothing moves or nothing is exposed: what "
        "they are made of, and their time with all that the CPU does.",
        measureStill};
}

} // namespace shutter::demand
