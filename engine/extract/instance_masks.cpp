// SPDX-License-Identifier: MIT
#include "engine/extract/instance_masks.h"

#include "engine/math/bounds.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>
#include <vector>

namespace shutter::extract {

namespace {

constexpr int kBitsPerMask = 3; // of seven: 35 masks, the most there can be

static_assert(std::popcount(kSharedInstanceMask) == kBitsPerMask);
static_assert((kSharedInstanceMask & ~shader::kSolidMask) == 0);

std::vector<uint32_t> makeInstanceMasks() {
    std::vector<uint32_t> masks;
    for (uint32_t mask = 1; mask <= shader::kSolidMask; ++mask)
        if ((mask & ~shader::kSolidMask) == 0 && std::popcount(mask) == kBitsPerMask &&
            mask != kSharedInstanceMask)
            masks.push_back(mask);
    return masks;
}

/// Rows a masked pixel may show: those in the picture whose motion can be longer than nothing.
std::vector<uint32_t> listMoving(const ExtractedFrame& frame) {
    std::vector<uint32_t> rows;
    const auto consider = [&](const std::vector<DrawItem>& draws) {
        for (const DrawItem& draw : draws)
            if (frame.entities[draw.entity].motion != shader::kNoMotion)
                rows.push_back(draw.entity);
    };
    consider(frame.opaque.moving);
    if (!frame.staticMotions.empty()) // the camera moves
        consider(frame.opaque.still);
    std::sort(rows.begin(), rows.end());
    rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
    return rows;
}

/// Rows that had a mask and now have none, since they left the picture.
std::vector<uint32_t>
listForgotten(const ExtractedFrame& frame, const std::vector<uint32_t>& moving) {
    std::vector<uint32_t> rows;
    const auto consider = [&](uint32_t row) {
        if (frame.entities[row].instanceMask != 0 &&
            !std::binary_search(moving.begin(), moving.end(), row))
            rows.push_back(row);
    };
    if (frame.staticMotions.empty())
        std::for_each(frame.movingRows.begin(), frame.movingRows.end(), consider);
    else
        for (uint32_t row = 0; row < frame.changes.ownRows; ++row)
            consider(row);
    return rows;
}

/// Size of the bounds as a share of their distance; any monotonic measure would do.
double computeApparentSize(const shader::EntityRow& row, const math::Bounds& bounds) {
    math::dmat4 matrix(1.0);
    for (int r = 0; r < 3; ++r)
        for (int column = 0; column < 4; ++column)
            matrix[column][r] = double(row.relWorldFromObject[r][column]);
    const math::Bounds placed = math::transformBounds(matrix, bounds);
    const double size = glm::length(placed.max - placed.min);
    const double share = size / std::max(glm::length(placed.centre()), 1.0e-9);
    return std::isfinite(share) ? share : 0.0; // NaN has no order
}

/// A row with the mask that it had is as it was.
void setMask(ExtractedFrame& frame, uint32_t row, uint32_t mask) {
    if (std::exchange(frame.entities[row].instanceMask, mask) != mask && !frame.changes.all)
        frame.changes.rows.push_back(row);
}

} // namespace

std::span<const uint32_t> listInstanceMasks() {
    static const std::vector<uint32_t> kMasks = makeInstanceMasks();
    return kMasks;
}

void assignInstanceMasks(ExtractedFrame& frame, const SceneLayout& layout) {
    std::vector<uint32_t> rows = listMoving(frame);
    std::vector<uint32_t> without = listForgotten(frame, rows); // all others have none
    const std::span<const uint32_t> masks = listInstanceMasks();
    if (rows.size() > masks.size()) {
        std::vector<std::pair<double, uint32_t>> sizes;
        for (const uint32_t row : rows)
            sizes.emplace_back(
                -computeApparentSize(
                    frame.entities[row], layout.bounds.at(frame.entityMeshes[row])
                ),
                row
            );
        std::nth_element(
            sizes.begin(), sizes.begin() + static_cast<ptrdiff_t>(masks.size()), sizes.end()
        );
        rows.clear();
        for (size_t i = 0; i < sizes.size(); ++i)
            (i < masks.size() ? rows : without).push_back(sizes[i].second);
        std::sort(rows.begin(), rows.end()); // who keeps a mask keeps the same, if it can
    }
    for (size_t i = 0; i < rows.size(); ++i)
        setMask(frame, rows[i], masks[i]);
    for (const uint32_t row : without)
        setMask(frame, row, 0);
}

} // namespace shutter::extract
