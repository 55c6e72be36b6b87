// SPDX-License-Identifier: MIT
#include "modules/motion_blur/embedding/check/last_frame.h"

#include "shaders/motion_blur/check_grid.glsl"
#include "shaders/motion_blur/prepare.glsl"

#include <algorithm>
#include <cmath>

namespace shutter::motion_blur {

namespace {

using math::dvec2;

constexpr double kTolerance = 0.02;
constexpr double kTolerancePixels = 1.0; ///< jitter, depth of fewer pixels than the picture's
/// Share by which the depths around a place differ from which an edge may lie between them.
constexpr double kEdge = 0.15;

/// Middles of a side's cells.
std::vector<double> listMiddles(uint32_t count, uint32_t sidePx) {
    std::vector<double> middles;
    for (uint32_t i = 0; i < count; ++i)
        middles.push_back(double(uint64_t(2 * i + 1) * sidePx / (2 * count)) + 0.5);
    return middles;
}

/// Finds the middle before a place that has one behind it, too.
std::optional<size_t> findBefore(const std::vector<double>& middles, double place) {
    const auto after = std::upper_bound(middles.begin(), middles.end(), place);
    if (after == middles.begin() || after == middles.end())
        return std::nullopt;
    return size_t(after - middles.begin()) - 1;
}

} // namespace

FineGrid::FineGrid(const CheckedFrame& frame) : mFrame(frame) {
    const VkExtent2D picture = frame.facts.picture;
    const glm::uvec2 size = shader::fineGrid({picture.width, picture.height});
    mColumns = listMiddles(size.x, picture.width);
    mRows = listMiddles(size.y, picture.height);
}

std::optional<FineGrid::Corners> FineGrid::find(const dvec2& place) const {
    const auto column = findBefore(mColumns, place.x);
    const auto row = findBefore(mRows, place.y);
    if (!column || !row)
        return std::nullopt;
    const size_t first = *row * mColumns.size() + *column;
    Corners corners{{first, first + 1, first + mColumns.size(), first + mColumns.size() + 1}};
    corners.spacingPx = {mColumns[*column + 1] - mColumns[*column], mRows[*row + 1] - mRows[*row]};
    corners.share = (place - dvec2(mColumns[*column], mRows[*row])) / corners.spacingPx;
    return corners;
}

std::optional<uint32_t> FineGrid::findId(const dvec2& place) const {
    const auto corners = find(place);
    if (!corners)
        return std::nullopt;
    const uint32_t* ids = mFrame.totals.fineIds;
    const uint32_t id = ids[corners->cells[0]];
    const bool isOne = std::all_of(corners->cells.begin(), corners->cells.end(), [&](size_t cell) {
        return ids[cell] == id;
    });
    return isOne ? std::optional(id) : std::nullopt;
}

FineDepth::FineDepth(const CheckedFrame& frame, const CheckFacts& declared)
    : mGrid(frame), mLinear(shader::kCheckFinePixels) {
    const shader::PrepareTable table = makePrepareTable(declared.convention, declared.picture);
    mIsPerspective = (table.flags & shader::kPreparePerspective) != 0;
    for (size_t i = 0; i < mLinear.size(); ++i) {
        const float depth = frame.totals.fineDepths[i];
        const double metres =
            shader::metresOfDepth(table, declared.flipsDepth ? 1.0f - depth : depth);
        mLinear[i] = mIsPerspective ? 1.0 / metres : metres;
    }
}

Match FineDepth::compare(const dvec2& place, double metres) const {
    const auto corners = mGrid.find(place);
    if (!corners || !(metres > 0.0))
        return Match::Unknown;
    std::array<double, 4> around{};
    for (size_t i = 0; i < around.size(); ++i)
        around[i] = mLinear[corners->cells[i]];
    const auto [least, most] = std::minmax_element(around.begin(), around.end());
    const double wanted = mIsPerspective ? 1.0 / metres : metres;
    if (*most - *least > kEdge * *most) {
        const bool isWithin =
            wanted >= *least * (1.0 - kTolerance) && wanted <= *most * (1.0 + kTolerance);
        return isWithin ? Match::Unknown : Match::Other;
    }
    const dvec2 share = corners->share;
    const double upper = glm::mix(around[0], around[1], share.x);
    const double lower = glm::mix(around[2], around[3], share.x);
    const dvec2 slope(
        (std::abs(around[1] - around[0]) + std::abs(around[3] - around[2])) / 2.0,
        (std::abs(around[2] - around[0]) + std::abs(around[3] - around[1])) / 2.0
    );
    const double perPixel = glm::length(slope / corners->spacingPx);
    const double off = std::abs(glm::mix(upper, lower, share.y) - wanted);
    return off <= kTolerance * wanted + kTolerancePixels * perPixel ? Match::Same : Match::Other;
}

bool FineDepth::isNear(const dvec2& place, double metres) const {
    const auto corners = mGrid.find(place);
    if (!corners)
        return false;
    const double linear = mLinear[corners->cells[0]];
    const double seen = mIsPerspective ? 1.0 / linear : linear;
    return seen >= 0.9 * metres && seen <= 1.02 * metres;
}

} // namespace shutter::motion_blur
