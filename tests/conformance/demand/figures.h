// SPDX-License-Identifier: MIT
// What is read off frames, figures and the parts of their graphs, and what is said of it.
#pragma once

#include "engine/math/statistics.h"
#include "tests/conformance/demand/claim.h"
#include "tests/conformance/demand/subject.h"

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace shutter::demand {

/// A number taken from one frame.
using Figure = std::function<double(const render::FrameStatistics&)>;

/// GPU milliseconds of the passes that `counts` picks.
[[nodiscard]] double sumPasses(
    const render::FrameStatistics& frame, const std::function<bool(const render::PassTime&)>& counts
);

/// GPU milliseconds that a method adds to the sharp frame, as everywhere in the benchmark.
[[nodiscard]] Figure effectOf(const game::MethodInfo& method);
/// Finding what will be revealed, and revealing it; what `hybrid` does beyond `gather`, apart from
/// the top level and the second layer of the last pass.
[[nodiscard]] bool isMaskOrReveal(const render::PassTime& pass);
/// Tracing and shading the rays.
[[nodiscard]] bool isReveal(const render::PassTime& pass);

[[nodiscard]] math::Quartiles summarize(const Frames& frames, const Figure& figure);

/// Ratio of a's figure to b's, round by round.
[[nodiscard]] math::Quartiles
compare(const Frames& a, const Frames& b, const Figure& ofA, const Figure& ofB);

/// "7 rounds, quartiles 1.02 to 1.06": how far a median can be trusted.
[[nodiscard]] std::string describeSpread(const math::Quartiles& quartiles, size_t rounds);

/// A check of the median; the note says the spread, then `more`.
[[nodiscard]] stability::Measured checkMedian(
    std::string check,
    const math::Quartiles& quartiles,
    double bound,
    std::string unit,
    size_t rounds,
    std::string_view more = {}
);

/// How far the points are from a line: 1 - r2 of its fit, at most 0.02 (r2 0.98 and more). Broken
/// where there is no fit.
/// \param points milliseconds against a quantity, by rising quantity
/// \param unit of the quantity, for the note
[[nodiscard]] stability::Measured
checkLine(std::string check, const std::vector<math::CurvePoint>& points, std::string_view unit);

/// What a frame was made of: a line each, as it stands in graph::dump().
struct GraphParts {
    std::vector<std::string> passes;
    std::vector<std::string> images;
    std::vector<std::string> buffers;
};

/// \param dump FrameResult::dump; of an empty one, no parts
[[nodiscard]] GraphParts readDump(std::string_view dump);

/// How many of `lines` have no equal among `others`, each of which answers for one.
[[nodiscard]] size_t
countBeyond(const std::vector<std::string>& lines, const std::vector<std::string>& others);

} // namespace shutter::demand
