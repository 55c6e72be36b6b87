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

/// Medians of the reveal's time against the pixels that are masked.
std::vector<math::CurvePoint> listMedians(const std::vector<Frames>& frames) {
    std::vector<math::CurvePoint> points;
    for (const Frames& one : frames)
        if (const double masked = countMasked(one.back()); masked > 0.0) {
            const auto time = summarize(one, [](const render::FrameStatistics& frame) {
                return sumPasses(frame, isReveal);
            });
            points.push_back({masked, time.median});
        }
    return points;
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
    findings.times.push_back(checkMedian(
        name + ": mask and reveal",
        time,
        kEmptyMaskMilliseconds,
        "ms",
        own.size(),
        fmt::format("the whole effect takes {:.4g} ms", effect.median)
    ));
    findings.counts.push_back(
        {name + ": pixels masked", countMasked(own.back()), 0.0, "", own.size()}
    );
    // Without this an effect that did not run would count as a cheap one.
    findings.counts.push_back(
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
    const std::vector<math::CurvePoint> medians = listMedians(frames.value());
    if (medians.empty())
        return core::makeError(
            "no pixel was masked in any picture of {}x{}", options.width, options.height
        );
    findings.times.push_back(checkLine("the reveal's distance from a line", medians, "masked pixel")
    );
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
