// SPDX-License-Identifier: MIT
#include "tests/conformance/demand/figures.h"

#include "game/shot/methods.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <limits>

namespace shutter::demand {

namespace {

bool contains(std::string_view text, std::string_view part) {
    return text.find(part) != std::string_view::npos;
}

} // namespace

double sumPasses(
    const render::FrameStatistics& frame, const std::function<bool(const render::PassTime&)>& counts
) {
    double sum = 0.0;
    for (const render::PassTime& pass : frame.passes)
        if (counts(pass))
            sum += pass.gpuMilliseconds;
    return sum;
}

Figure effectOf(const game::MethodInfo& method) {
    return [&method](const render::FrameStatistics& frame) {
        return game::sumBlurMilliseconds(method, frame);
    };
}

bool isMaskOrReveal(const render::PassTime& pass) {
    const bool isNamedSo =
        contains(pass.name, "edge") || contains(pass.name, "mask") || contains(pass.name, "reveal");
    return isNamedSo && !pass.name.starts_with("gather");
}

bool isReveal(const render::PassTime& pass) {
    return contains(pass.name, "reveal") && !contains(pass.name, " of reveal");
}

math::Quartiles summarize(const Frames& frames, const Figure& figure) {
    std::vector<double> values;
    for (const render::FrameStatistics& frame : frames)
        values.push_back(figure(frame));
    return math::computeQuartiles(std::move(values));
}

math::Quartiles compare(const Frames& a, const Frames& b, const Figure& ofA, const Figure& ofB) {
    std::vector<double> ratios;
    for (size_t round = 0; round < std::min(a.size(), b.size()); ++round) {
        const double below = ofB(b[round]);
        // A NaN among them would leave them without an order.
        ratios.push_back(
            below > 0.0 ? ofA(a[round]) / below : std::numeric_limits<double>::infinity()
        );
    }
    return math::computeQuartiles(std::move(ratios));
}

std::string describeSpread(const math::Quartiles& quartiles, size_t rounds) {
    return fmt::format("{} rounds, quartiles {:.4g} to {:.4g}", rounds, quartiles.q1, quartiles.q3);
}

stability::Measured checkMedian(
    std::string check,
    const math::Quartiles& quartiles,
    double bound,
    std::string unit,
    size_t rounds,
    std::string_view more
) {
    std::string note = describeSpread(quartiles, rounds);
    if (!more.empty())
        note += fmt::format("; {}", more);
    return {std::move(check), quartiles.median, bound, std::move(unit), rounds, 0, std::move(note)};
}

stability::Measured
checkLine(std::string check, const std::vector<math::CurvePoint>& points, std::string_view unit) {
    constexpr double kUnexplained = 0.02;
    stability::Measured row{std::move(check), 0.0, kUnexplained, "1 - r²", points.size()};
    // Any two points lie on a line.
    constexpr size_t kLeastPoints = 4;
    const auto line = math::fitLine(points);
    if (!line || points.size() < kLeastPoints) {
        row.worst = std::numeric_limits<double>::quiet_NaN();
        row.note = "too few points for a line";
        return row;
    }
    row.worst = std::max(1.0 - line->r2, 0.0);
    row.note = fmt::format("{:.4g} ms and {:.4g} a {}", line->intercept, line->slope, unit);
    return row;
}

GraphParts readDump(std::string_view dump) {
    // A section is a line "name: count" and, indented by two, a line for each; what belongs to one
    // of those is indented farther.
    GraphParts parts;
    std::vector<std::string>* section = nullptr;
    while (!dump.empty()) {
        const size_t end = dump.find('\n');
        const std::string_view line = dump.substr(0, end);
        dump.remove_prefix(end == std::string_view::npos ? dump.size() : end + 1);
        if (line.empty())
            continue;
        if (line.front() != ' ') {
            section = line.starts_with("passes:")    ? &parts.passes
                      : line.starts_with("images:")  ? &parts.images
                      : line.starts_with("buffers:") ? &parts.buffers
                                                     : nullptr;
            continue;
        }
        const bool isEntry = line.starts_with("  ") && line.size() > 2 && line[2] != ' ';
        if (section == nullptr || !isEntry)
            continue;
        // "3 'tile max' (compute)": its place in the frame is not part of it.
        std::string_view entry = line.substr(2);
        if (section == &parts.passes) {
            const size_t name = entry.find('\'');
            if (name == std::string_view::npos)
                continue; // barriers at the frame's end
            if (!std::isdigit(static_cast<unsigned char>(entry.front())))
                continue;
            entry.remove_prefix(name);
        }
        section->emplace_back(entry);
    }
    return parts;
}

size_t countBeyond(const std::vector<std::string>& lines, const std::vector<std::string>& others) {
    std::vector<std::string> left = others;
    size_t beyond = 0;
    for (const std::string& line : lines) {
        const auto same = std::find(left.begin(), left.end(), line);
        if (same == left.end())
            ++beyond;
        else
            left.erase(same);
    }
    return beyond;
}

} // namespace shutter::demand
