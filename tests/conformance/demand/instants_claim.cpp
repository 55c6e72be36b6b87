// SPDX-License-Identifier: MIT
#include "tests/conformance/demand/figures.h"
#include "tests/conformance/demand/subject.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace shutter::demand {

namespace {

constexpr double kExposureSeconds = 1.0 / 60.0;
constexpr double kStepPx = 1.0;
/// Metres per second of a panel five metres ahead.
constexpr std::array kSpeeds{0.0, 2.5, 5.0, 10.0, 20.0};

std::unique_ptr<Stage> makePanelStage(double speed) {
    test::SceneBuilder scene = stability::makeEmptyScene();
    test::Placement panel{.position = {0, 0, -5}};
    panel.velocity = {speed, 0, 0};
    stability::addShape(scene, stability::makeSheetShape(1, 1), scene.addLitWaves(), panel);
    stability::addShape(
        scene,
        stability::makeSheetShape(60, 60),
        scene.addLitWaves(),
        test::Placement{.position = {0, 0, -9}}
    );
    scene.addSun(math::dvec3(0, 0, -1), 3.0f);
    return makeStage(std::move(scene), kExposureSeconds);
}

core::Result<Findings> measureInstants(gpu::Device& device, const DemandOptions& options) {
    Findings findings;
    Curve instants{"instants", "Instants of a frame", "speed", "m/s", "instants", "", {}};
    Curve time{"time-of-instants", "Time of a frame", "instants", "", "time", "ms", {}};
    for (const double speed : kSpeeds) {
        const auto stage = makePanelStage(speed);
        auto subject = Subject::create(device, *stage, "accumulate", options.width, options.height);
        if (!subject)
            return subject.error();
        subject.value()->setMaxStep(kStepPx);
        Subjects subjects;
        subjects.push_back(std::move(subject).value());
        auto frames = takeTurns(subjects, options.rounds);
        if (!frames)
            return frames.error();
        const Frames& own = frames.value().front();
        const auto count = [](const render::FrameStatistics& frame) {
            return double(frame.counters.at("instants"));
        };
        const double found = count(own.back());
        if (speed == 0.0)
            findings.checks.push_back(
                {"a still frame: instants beyond one", found - 1.0, 0.0, "", own.size()}
            );
        instants.points.push_back({speed, summarize(own, count), fmt::format("{:.0f}", found)});
        time.points.push_back(
            {found,
             summarize(own, [](const auto& frame) { return game::sumFrameMilliseconds(frame); }),
             fmt::format("{} m/s", speed)}
        );
    }
    double off = 0.0;
    const double most = instants.points.back().y.median;
    for (size_t i = 1; i < kSpeeds.size(); ++i)
        off = std::max(
            off, std::abs(instants.points[i].y.median - most * kSpeeds[i] / kSpeeds.back())
        );
    findings.checks.push_back(
        {"instants out of proportion to the motion", off, 1.0, "", kSpeeds.size() - 1}
    );
    addLine(time);
    findings.checks.push_back(checkLine("the time's distance from a line of the instants", time));
    findings.curves = {std::move(instants), std::move(time)};
    return findings;
}

} // namespace

Claim makeInstantsClaim() {
    return {
        "Instants",
        "Accumulation costs what moves",
        "Frames of accumulate that take their instants from the motion, of a panel that stands "
        "still and of ones that move faster and faster.",
        measureInstants};
}

} // namespace shutter::demand
