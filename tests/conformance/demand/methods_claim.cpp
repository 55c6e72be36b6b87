// SPDX-License-Identifier: MIT
#include "tests/conformance/demand/figures.h"
#include "tests/conformance/demand/rooms.h"

#include <algorithm>
#include <set>
#include <utility>
#include <vector>

namespace shutter::demand {

namespace {

/// Hybrid's frame over gather's. The publication has 1.44 on a real GPU.
constexpr double kHybridOnSoftware = 1.4;
constexpr double kHybridOnHardware = 1.25;

/// "gather 19.1 ms, tile max 3.5 ms": passes beside the G-buffer, dearest first.
std::string describePasses(const Frames& frames) {
    std::vector<std::pair<double, std::string>> rows;
    std::set<std::string> names;
    for (const render::PassTime& pass : frames.back().passes)
        if (pass.owner != render::PassOwner::Display && names.insert(pass.name).second)
            rows.emplace_back(
                summarize(
                    frames,
                    [&](const render::FrameStatistics& frame) {
                        return sumPasses(frame, [&](const render::PassTime& other) {
                            return other.name == pass.name;
                        });
                    }
                ).median,
                pass.name
            );
    std::sort(rows.rbegin(), rows.rend());
    std::string text;
    for (const auto& [milliseconds, name] : rows)
        if (milliseconds >= 0.01)
            text += fmt::format("{}{} {:.3g}", text.empty() ? "" : ", ", name, milliseconds);
    return text;
}

core::Status
addRoom(Findings& findings, gpu::Device& device, const DemandOptions& options, const Room& room) {
    auto stage = loadRoom(options, room);
    if (!stage)
        return stage.error();
    Subjects subjects;
    for (const char* method : {"gather", "hybrid", "resolved"}) {
        auto subject =
            Subject::create(device, *stage.value(), method, options.width, options.height);
        if (!subject)
            return subject.error();
        subjects.push_back(std::move(subject).value());
    }
    auto frames = takeTurns(subjects, options.rounds);
    if (!frames)
        return frames.error();
    const Frames& gather = frames.value()[0];
    const bool isSoftware = device.info().kind == "software";
    const double limits[] = {
        isSoftware ? kHybridOnSoftware : kHybridOnHardware, room.resolvedOverGather};
    for (size_t i = 1; i < subjects.size(); ++i) {
        const Frames& other = frames.value()[i];
        const char* name = subjects[i]->method().name;
        findings.checks.push_back(checkMedian(
            fmt::format("{}: {}'s frame", room.name, name),
            compare(other, gather, frameTime(), frameTime()),
            limits[i - 1],
            "of gather's",
            other.size(),
            fmt::format(
                "ms of gather: {}; of {}: {}", describePasses(gather), name, describePasses(other)
            )
        ));
    }
    return {};
}

core::Result<Findings> measureMethods(gpu::Device& device, const DemandOptions& options) {
    return measureRooms(device, options, addRoom);
}

} // namespace

Claim makeMethodsClaim() {
    return {
        "MethodsAgainstGather",
        "What rays and looking things up add to the gather",
        "The frames of hybrid and resolved against those of gather, G-buffer included, on two "
        "rooms with "
        "movers before detailed backgrounds.",
        measureMethods};
}

} // namespace shutter::demand
