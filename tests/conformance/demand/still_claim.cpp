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

constexpr const char* kMethods[] = {"hybrid", "resolved"};

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

/// A film of one method in one scene.
struct Film {
    gpu::Device& device;
    const Stage& stage;
    const DemandOptions& options;
    const char* method;
    const char* why;

    [[nodiscard]] std::string nameCheck(const char* check) const {
        return fmt::format("{}: {}: {}", why, method, check);
    }
};

/// sharp and the film's method, frame after frame.
core::Result<Subjects> makePair(const Film& film, uint32_t width, uint32_t height) {
    Subjects subjects;
    for (const char* method : {"sharp", film.method}) {
        auto subject = Subject::create(film.device, film.stage, method, width, height);
        if (!subject)
            return subject.error();
        // Else a method that keeps the last frame would draw that one, too, before each picture.
        subject.value()->setStep(scene::kStillFrameSeconds);
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
core::Status addParts(Findings& findings, const Film& film) {
    const uint32_t levelsBefore = film.device.living().accelerationStructures;
    auto subjects = makePair(film, film.options.width, film.options.height);
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
    const GraphParts blurred = readDump(drawn[1].dump);
    const uint64_t passCount = blurred.passes.size();
    const auto add = [&](const char* check, uint64_t found, const char* unit, uint64_t samples) {
        findings.counts.push_back({film.nameCheck(check), double(found), 0.0, unit, samples});
    };
    add("passes beyond sharp's", countBeyond(blurred.passes, sharp.passes), "", passCount);
    add("images beyond sharp's",
        countBeyond(blurred.images, sharp.images),
        "",
        blurred.images.size());
    add("buffers beyond sharp's", countBeyond(blurred.buffers, sharp.buffers), "", passCount);
    const uint64_t most =
        std::max(drawn[0].statistics.transientBytes, drawn[1].statistics.transientBytes);
    const uint64_t least =
        std::min(drawn[0].statistics.transientBytes, drawn[1].statistics.transientBytes);
    add("memory that differs from sharp's", most - least, "bytes", most);
    const uint32_t levels = film.device.living().accelerationStructures;
    add("acceleration structures made",
        levels - std::min(levels, levelsBefore), // earlier ones may have gone meanwhile
        "",
        passCount);
    add("values that differ from sharp's",
        countValuesThatDiffer(drawn[0].display, drawn[1].display),
        "",
        drawn[1].display.pixels.size());
    return {};
}

core::Status addTime(Findings& findings, const Film& film) {
    const uint32_t width = std::max(film.options.width / kSmaller, 1u);
    const uint32_t height = std::max(film.options.height / kSmaller, 1u);
    auto subjects = makePair(film, width, height);
    if (!subjects)
        return subjects.error();
    auto frames = takeTurns(subjects.value(), film.options.rounds * kMoreRounds);
    if (!frames)
        return frames.error();
    // On a software device the frame is the processors' work, whoever else uses them.
    const bool isSoftware = film.device.info().kind == "software";
    const Figure time = [isSoftware](const render::FrameStatistics& frame) {
        return isSoftware ? frame.measures.at(kProcessMilliseconds) : frame.wallMilliseconds;
    };
    const Frames& sharp = frames.value()[0];
    const Frames& blurred = frames.value()[1];
    findings.times.push_back(checkMedian(
        film.nameCheck("time of the frame"),
        compare(blurred, sharp, time, time),
        kFrameRatio,
        "of sharp's",
        blurred.size(),
        fmt::format(
            "{:.4g} against {:.4g} ms {} at {}x{}",
            summarize(blurred, time).median,
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
        for (const char* method : kMethods)
            for (const auto add : {addParts, addTime})
                SHUTTER_TRY(add(findings, {device, *stage.value(), options, method, scene.why}));
    }
    return findings;
}

} // namespace

Claim makeStillClaim() {
    return {
        "Still",
        "Stillness costs nothing",
        "Frames of hybrid and resolved against frames of sharp where nothing moves or nothing is "
        "exposed: what "
        "they are made of, and their time with all that the CPU does.",
        measureStill};
}

} // namespace shutter::demand
