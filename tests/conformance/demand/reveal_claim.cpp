// SPDX-License-Identifier: MIT
#include "tests/conformance/demand/figures.h"
#include "tests/conformance/demand/regions.h"

namespace shutter::demand {

namespace {

constexpr double kEmptyMaskMilliseconds = 0.3;
constexpr double kExposureSeconds = 1.0 / 60.0;

double countMasked(const render::FrameStatistics& frame) {
    const auto found = frame.counters.find("pixels masked");
    return found == frame.counters.end() ? 0.0 : double(found->second);
}

Curve drawCurve(
    std::string name,
    std::string title,
    const std::vector<Frames>& frames,
    bool (*counts)(const render::PassTime&)
) {
    Curve curve{std::move(name), std::move(title), "pixels masked", "", "time", "ms", {}};
    const Figure time = [counts](const render::FrameStatistics& frame) {
        return sumPasses(frame, counts);
    };
    for (const Frames& one : frames) {
        const double masked = countMasked(one.back());
        if (masked > 0.0)
            curve.points.push_back({masked, summarize(one, time), fmt::format("{:.0f}", masked)});
    }
    addLine(curve);
    return curve;
}

/// A sheet that fills the picture, before and after it moves, in front of a wall that rays could
/// find.
std::unique_ptr<Stage> makeSheetStage(const test::Placement& movement) {
    test::SceneBuilder scene = stability::makeEmptyScene();
    test::Placement placement = movement;
    placement.position = {0, 0, -5};
    stability::addShape(scene, stability::makeSheetShape(30, 30), scene.addLitWaves(), placement);
    stability::addShape(
        scene,
        stability::makeSheetShape(60, 60),
        scene.addLitWaves(),
        test::Placement{.position = {0, 0, -9}}
    );
    scene.addSun(math::dvec3(0, 0, -1), 3.0f);
    return makeStage(std::move(scene), kExposureSeconds);
}

core::Status addEmptyMask(
    Findings& findings,
    gpu::Device& device,
    const DemandOptions& options,
    const std::string& name,
    const test::Placement& movement
) {
    const auto stage = makeSheetStage(movement);
    auto subject = Subject::create(device, *stage, "hybrid", options.width, options.height);
    if (!subject)
        return subject.error();
    Subjects subjects;
    subjects.push_back(std::move(subject).value());
    auto frames = takeTurns(subjects, options.rounds);
    if (!frames)
        return frames.error();
    const Frames& own = frames.value().front();
    const auto time = summarize(own, [](const render::FrameStatistics& frame) {
        return sumPasses(frame, isMaskOrReveal);
    });
    const auto effect = summarize(own, effectOf(subjects.front()->method()));
    findings.checks.push_back(checkMedian(
        name + ": mask and reveal",
        time,
        kEmptyMaskMilliseconds,
        "ms",
        own.size(),
        fmt::format("the whole effect takes {:.4g} ms", effect.median)
    ));
    findings.checks.push_back(
        {name + ": pixels masked", countMasked(own.back()), 0.0, "", own.size()}
    );
    // Without this an effect that did not run would count as a cheap one.
    findings.checks.push_back(
        {name + ": frames without the effect", effect.median > 0.0 ? 0.0 : 1.0, 0.0, "", own.size()}
    );
    return {};
}

core::Result<Findings> measureReveal(gpu::Device& device, const DemandOptions& options) {
    if (!device.hasRays())
        return core::makeError("{} traces no rays", device.info().name);
    auto regions = loadRegions(device, options);
    if (!regions)
        return regions.error();
    auto subjects = makeSubjects(device, regions.value(), "hybrid", options);
    if (!subjects)
        return subjects.error();
    auto frames = takeTurns(subjects.value(), options.rounds);
    if (!frames)
        return frames.error();
    Findings findings;
    findings.curves = {
        drawCurve("reveal", "The reveal", frames.value(), isReveal),
        drawCurve("mask-and-reveal", "Edge, mask and reveal", frames.value(), isMaskOrReveal)};
    if (findings.curves.front().points.empty())
        return core::makeError(
            "no pixel was masked in any picture of {}x{}", options.width, options.height
        );
    findings.checks.push_back(checkLine("the reveal's distance from a line", findings.curves[0]));
    // About 24 px at 1280x720 in both, everywhere alike or from 0 in the middle.
    SHUTTER_TRY(
        addEmptyMask(findings, device, options, "a sheet that slides", {.velocity = {9.7, 0, 0}})
    );
    SHUTTER_TRY(addEmptyMask(
        findings, device, options, "a sheet that turns", {.angularVelocity = {0, 0, 2.25}}
    ));
    return findings;
}

} // namespace

Claim makeRevealClaim() {
    return {
        "Reveal",
        "Rays are paid for by the masked pixel",
        "Panels before a wall, of which more and more move: the time of the reveal against the "
        "pixels of the ray mask; then sheets that fill the picture and move, behind which nothing "
        "comes into sight.",
        measureReveal};
}

} // namespace shutter::demand
