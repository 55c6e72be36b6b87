// SPDX-License-Identifier: MIT
#include "tests/conformance/demand/figures.h"
#include "tests/conformance/demand/rooms.h"

#include <algorithm>
#include <cmath>

namespace shutter::demand {

namespace {

/// A step that is not the first starts at another place of the ray, so a hit moves by rounding.
constexpr double kColorDifference = 1.0 / 256.0;
/// More surfaces than an object of the rooms has, so that stepping ends where a single traversal
/// does.
constexpr const char* kEnoughSteps = "recursionLimit=64";
constexpr const char* kSingle = "revealTraversal=single";
constexpr const char* kStepping = "revealTraversal=stepping";

core::Result<render::FrameResult> drawReveal(
    gpu::Device& device, const Stage& stage, const DemandOptions& options, const char* traversal
) {
    auto subject = Subject::create(
        device, stage, "hybrid", options.width, options.height, {traversal, kEnoughSteps}
    );
    if (!subject)
        return subject.error();
    subject.value()->setIntermediates({"mask", "reveal", "reveal_id"});
    return subject.value()->draw();
}

/// Looks at the masked pixels.
void addAgreement(
    Findings& findings,
    const std::string& room,
    const render::FrameResult& single,
    const render::FrameResult& stepping
) {
    const auto& ours = single.intermediates;
    const auto& theirs = stepping.intermediates;
    const image::Image& mask = ours.at("mask");
    uint64_t masked = 0;
    uint64_t otherObjects = 0;
    double worst = 0.0;
    for (uint32_t y = 0; y < mask.height; ++y)
        for (uint32_t x = 0; x < mask.width; ++x) {
            if (mask.at(x, y, 0) < 0.5f)
                continue;
            ++masked;
            otherObjects += ours.at("reveal_id").at(x, y, 0) != theirs.at("reveal_id").at(x, y, 0);
            for (uint32_t c = 0; c < 3; ++c) {
                const double a = ours.at("reveal").at(x, y, c);
                const double b = theirs.at("reveal").at(x, y, c);
                worst =
                    std::max(worst, std::abs(a - b) / std::max({std::abs(a), std::abs(b), 0.1}));
            }
        }
    findings.checks.push_back(
        {room + ": pixels that reveal another object", double(otherObjects), 0.0, "", masked}
    );
    findings.checks.push_back(
        {room + ": largest difference of a colour",
         worst,
         kColorDifference,
         "of the colour",
         masked}
    );
}

core::Status
addRoom(Findings& findings, gpu::Device& device, const DemandOptions& options, const Room& room) {
    auto stage = loadRoom(options, room);
    if (!stage)
        return stage.error();
    const auto single = drawReveal(device, *stage.value(), options, kSingle);
    const auto stepping = drawReveal(device, *stage.value(), options, kStepping);
    if (!single || !stepping)
        return single ? stepping.error() : single.error();
    addAgreement(findings, room.name, single.value(), stepping.value());
    Subjects subjects;
    for (const char* traversal : {kSingle, kStepping}) {
        auto subject = Subject::create(
            device, *stage.value(), "hybrid", options.width, options.height, {traversal}
        );
        if (!subject)
            return subject.error();
        subjects.push_back(std::move(subject).value());
    }
    auto frames = takeTurns(subjects, options.rounds);
    if (!frames)
        return frames.error();
    const Figure time = [](const render::FrameStatistics& frame) {
        return sumPasses(frame, isReveal);
    };
    const Frames& one = frames.value()[0];
    const Frames& steps = frames.value()[1];
    findings.checks.push_back(checkMedian(
        fmt::format("{}: a single traversal", room.name),
        compare(one, steps, time, time),
        1.0,
        "of stepping's time",
        one.size(),
        fmt::format(
            "{:.4g} against {:.4g} ms", summarize(one, time).median, summarize(steps, time).median
        )
    ));
    return {};
}

core::Result<Findings> measureTraversals(gpu::Device& device, const DemandOptions& options) {
    return measureRooms(device, options, addRoom);
}

} // namespace

Claim makeTraversalClaim() {
    return {
        "RevealTraversal",
        "One traversal does what stepping does",
        "The reveal by one traversal that leaves the object in front out, against stepping from "
        "hit to hit: what they find, and their time.",
        measureTraversals};
}

} // namespace shutter::demand
